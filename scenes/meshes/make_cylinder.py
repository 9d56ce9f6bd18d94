#!/usr/bin/env python3
# scenes/meshes/make_cylinder.py - writes cylinder.obj: python3 make_cylinder.py > cylinder.obj
from math import cos, log, pi, sin, tan

facets = 240
half = pi / facets
# A facet at distance d from the axis is d / cos(phi) away at the angle phi from its middle: the mean over the facet is 1.
vertex_radius = half / log(1 / cos(half) + tan(half)) / cos(half)

print("# scenes/meshes/cylinder.obj - lateral surface of a cylinder: axis z, z from -0.5 to 0.5, 240 facets, 480 triangles.")
print(f"# The mean radius of the facets is 1; the vertices lie at radius {vertex_radius:.9f}. Made by make_cylinder.py.")
for z in (-0.5, 0.5):
    for k in range(facets):
        phi = 2 * pi * k / facets
        print(f"v {vertex_radius * cos(phi):.15g} {vertex_radius * sin(phi):.15g} {z}")
for k in range(facets):
    a, b = k + 1, (k + 1) % facets + 1
    print(f"f {a} {b} {b + facets}")
    print(f"f {a} {b + facets} {a + facets}")
