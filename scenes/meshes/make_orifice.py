#!/usr/bin/env python3
# scenes/meshes/make_orifice.py - writes orifice.obj: python3 make_orifice.py > orifice.obj
from math import cos, pi, sin

facets, rings = 96, [1, 1.25, 1.6, 2.1, 2.8, 3.8, 5.2, 7, 9.5, 12]

print("# scenes/meshes/orifice.obj - a flat plate, z = 0, around a round hole of radius 1; its rim has radius 12. 96 facets, 1728 triangles.")
print("# The hole's area is that of the circle: its corners lie a little outside. Made by make_orifice.py.")
corner = (2 * pi / facets / sin(2 * pi / facets)) ** 0.5     # of a polygon whose area is pi
for radius in rings:
    for k in range(facets):
        phi = 2 * pi * k / facets
        print(f"v {radius * corner * cos(phi):.15g} {radius * corner * sin(phi):.15g} 0")
for ring in range(len(rings) - 1):
    for k in range(facets):
        a, b = ring * facets + k + 1, ring * facets + (k + 1) % facets + 1
        print(f"f {a} {a + facets} {b + facets}")
        print(f"f {a} {b + facets} {b}")
