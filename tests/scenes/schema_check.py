# tests/scenes/schema_check.py - the JSON Schema is one, the shipped scenes obey it, and it agrees with the reader.
# Usage: schema_check.py SCENE_TOOL FOLDER_OF_SCENES
import json
import pathlib
import subprocess
import sys
import tempfile

import jsonschema

tool, scenes = sys.argv[1], pathlib.Path(sys.argv[2])


def output(*arguments):
    return subprocess.run([tool, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


schema = json.loads(output("schema"))
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)


def schema_accepts(path):
    return next(validator.iter_errors(json.loads(output("json", path))), None)


def reader_accepts(path):
    return subprocess.run([tool, "check", str(path)], capture_output=True).returncode == 0


good = """
end_time: 1 s
materials: [{name: pellet, density: 3700, youngs_modulus: 6 MPa}]
particles: [{list: [{radius: 1 cm, position: [0, 0, "= 1 / 2"]}]}]
bodies: [{name: floor, geometries: [{plane: {}}]}]
"""
changes = [  # text, its replacement, whether the scene stays good
    ("end_time: 1 s", "end_time: 1.5e-1", True),
    ("end_time: 1 s", "end_time: 1\ntime_step: auto\ngravity: [0, 0, -1 g_n]\nseed: 7\nbounds: none", True),
    ("{plane: {}}", "{sphere: {radius: 1}, orientation: {axis: [0, 0, 1], angle: 30 deg}, ring: {count: 3}}", True),
    ("{plane: {}}", "{box: {size: [1, 1, 1]}, orientation: [1, 0, 0, 0]}", True),
    ("end_time: 1 s", "end_tme: 1 s", False),
    ("end_time: 1 s", "end_time: long", False),
    ("end_time: 1 s", "end_time: -1", False),
    ("end_time: 1 s", "end_time: 0", False),
    ("end_time: 1 s", "end_time: [1]", False),
    ("end_time: 1 s", "", False),
    ("end_time: 1 s", "end_time: 1\nmethod: mdem", False),
    ("end_time: 1 s", "end_time: 1\ngravity: [0, 0]", False),
    ("end_time: 1 s", "end_time: 1\nseed: 1.5", False),
    ("end_time: 1 s", "end_time: 1\noutput: {contacts: 1}", False),
    ("density: 3700", "density: 0", False),
    ("density: 3700", "density: 1, restitution: 2", False),
    ("density: 3700", "density: 1, poissons_ratio: -1", False),
    ("density: 3700, ", "", False),
    ("{list: ", "{lists: ", False),
    ("{plane: {}}", "{plane: {}, sphere: {radius: 1}}", False),
    ("{plane: {}}", "{box: {size: 1}}", False),
    ("{plane: {}}", "{}", False),
    ("particles:", "particle:", False),
]

failures = []
for scene in sorted(scenes.glob("*.yaml")):
    if error := schema_accepts(scene):
        failures.append(f"{scene.name}: {error.message} at {list(error.absolute_path)}")
    resolved = output("resolve", scene)
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        file.write(resolved)
        file.flush()
        if error := schema_accepts(file.name):
            failures.append(f"resolved {scene.name}: {error.message} at {list(error.absolute_path)}")
for old, new, is_good in [("", "", True), *changes]:
    assert old in good, old
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        file.write(good.replace(old, new, 1))
        file.flush()
        verdicts = schema_accepts(file.name) is None, reader_accepts(file.name)
    if verdicts != (is_good, is_good):
        failures.append(f"{old!r} -> {new!r}: schema {verdicts[0]}, reader {verdicts[1]}, expected {is_good}")

print("\n".join(failures) or f"{len(changes) + 1} scenes: schema and reader agree")
sys.exit(bool(failures))
