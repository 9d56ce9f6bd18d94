#!/usr/bin/env python3
"""tests/system/check_test.py - the verb `check`: verdicts, exit codes, the page and the JSON: see program.py."""
import re

from program import contains, json, main, read, write

FALL = """\
check:
  title: A stone falls
  group: contact
  source: Galilei 1638
  track: {height: "z(0)"}
  expect:
    - {what: "height [m]", value: "z(0)", expected: "-9.81 * t^2 / 2", tolerance: LIMIT}
end_time: 0.1 s
time_step: 0.1 ms
materials: [{name: stone, density: 2500, youngs_modulus: 1 MPa}]
particles: [{list: [{radius: 1 cm, position: [0, 0, 0]}]}]
"""


def case_verdicts(program):
    write("fall.yaml", FALL.replace("LIMIT", "1 %"))
    done = program("check", "fall.yaml", "--report", "page.html", "--json", "all.json")
    assert done.returncode == 0, done
    contains(done.stdout, ["fall: A stone falls", "sdem  height [m]", "ndem  height [m]", "pass", "all 1 cases pass: 2 comparisons"])
    contains(read("page.html"), ["<!doctype html>", "A stone falls", "Galilei 1638", "<svg", "smooth DEM", "time [s]", "materials:"])
    one = json.loads(read("all.json"))["cases"][0]
    assert (one["name"], one["passed"], len(one["verdicts"]), len(one["runs"])) == ("fall", True, 2, 2), one
    assert abs(one["verdicts"][0]["measured"] + 9.81 * 0.01 / 2) < 1e-9


def case_a_failure_exits_6(program):
    write("fall.yaml", FALL.replace("LIMIT", "1e-9"))      # symplectic Euler is late by half a step
    done = program("check", "fall.yaml", code=6)
    contains(done.stdout, ["sdem", "pass", "FAIL", "1 of 1 cases fail, 1 of 2 comparisons: fall"])
    program.run("fall.yaml")                               # the same file runs as a scene


def case_what_is_refused(program):
    contains(program("check", "--only", "hertz-impac", code=2).stderr, ["there is no case 'hertz-impac'", "did you mean 'hertz-impact'"])
    contains(program("check", "--show", "nothing-like-it", code=2).stderr, ["there is no case"])
    write("plain.yaml", FALL[FALL.index("end_time"):])
    contains(program("check", "plain.yaml", code=3).stderr, ["plain.yaml", "no 'check' section"])
    contains(program("check", "absent.yaml", code=3).stderr, ["absent.yaml", "cannot read"])
    write("fall.yaml", FALL.replace("LIMIT", "1 %").replace("what:", "whot:"))
    contains(program("check", "fall.yaml", code=3).stderr, ["unknown key 'whot'", "did you mean 'what'"])
    write("fall.yaml", FALL.replace("LIMIT", "1 %"))
    program("check", "fall.yaml", "--report", "no/such/folder/page.html", code=5)


def case_the_programs_own_cases(program):
    listed = program("check", "--list").stdout
    contains(listed, ["single contacts", "hertz-impact", "hard cases", "(--all)"])
    names = re.findall(r"^  ([a-z0-9-]+)", listed, re.M)
    assert len(names) == len(set(names)) > 10
    write("own.yaml", program("check", "--show", "hertz-impact").stdout)
    program("validate", "own.yaml", "--set", "end_time=1 us")
    contains(program("check", "--only", "hertz-impact,restitution", "--jobs", "2").stdout, ["all 2 cases pass"])
    contains(program("check", "--only", "hertz*", "-v").stdout, ["material = glass", "material = pellet"])


if __name__ == "__main__":
    main(globals())
