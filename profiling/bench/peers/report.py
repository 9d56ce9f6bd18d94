# profiling/bench/peers/report.py - medians, paired ratios, and the table in Markdown.
"""A ratio is taken within a repeat, where the two runs lie next to each other in time, so that a machine that drifts leaves
little trace in it; its median over the repeats is reported with the range. A rate alone is that of one day on one machine."""
from collections import defaultdict
from statistics import median

CONTACTS_AGREE = 0.03                   # contacts per particle may differ from Skred's by this much

DIFFERENCES = """\
What is equal: the state at the start (positions, velocities, spins to 12 digits; springs empty), the time step of 50 us, the
number of timed steps, E, nu, density, friction, rolling friction, restitution as measured in a collision, double precision.
What is not:

- Normal: Skred's force never pulls, and its damping makes up for that; the others' may pull for a moment. LAMMPS is given
  e = 0.0538, with which its Tsuji damping makes the measured restitution of 0.18.
- Tangential: the same spring and dashpot in all three (LAMMPS `mindlin`, LIGGGHTS `history`), but they differ in how the dashpot
  counts at the limit of friction.
- Rolling: Skred and LIGGGHTS (`epsd2`) tie the spring to the contact's tangential stiffness; LAMMPS has a constant 4000 N/m.
- Curved walls: LAMMPS puts the wall's curvature into the effective radius, the others do not. LIGGGHTS uses the faster of
  a mesh (240 or 96 sides) and a primitive, LAMMPS a rotating region for the drum, Skred the smooth surface.
- Skred's result does not depend on the number of threads, to the bit; theirs depends on the number of processes.
- Skred uses threads in one process, the others MPI processes bound to cores. Skin and splits of the others are in the table of
  settings; Skred chooses its own."""


def spread(values):
    return (median(values), min(values), max(values)) if values else (0.0, 0.0, 0.0)


def range_text(values, form="{:.2f}"):
    if not values:
        return "failed"
    middle, least, most = (form.format(value) for value in spread(values))
    return middle if len(values) == 1 else f"{middle} ({least}-{most})"


def group(results, quiet):
    """good[scene, processes][code][repeat] = result, of the runs without problems, in the order of first appearance. Runs that
    other work disturbed are left out where there are undisturbed ones of the same kind."""
    good = defaultdict(lambda: defaultdict(dict))
    for r in results:
        runs = good[r.scene, r.processes][r.code]
        if not r.problems:
            runs[r.repeat] = r
    for codes in good.values():
        for code, runs in codes.items():
            codes[code] = {k: r for k, r in runs.items() if r.others <= quiet} or runs
    return good


def ratios(numerator, denominator):
    """Of the rates, within each repeat that both have."""
    return [numerator[k].rate / denominator[k].rate for k in sorted(numerator.keys() & denominator.keys())]


def summary(results, quiet, skred="Skred"):
    """A dictionary per scene and process count: what the JSON file and the table show."""
    rows = []
    for (scene, processes), codes in group(results, quiet).items():
        row = {"scene": scene, "processes": processes, "codes": {}, "ratios": {}}
        for code, runs in codes.items():
            rates, contacts = [r.rate for r in runs.values()], [r.contacts for r in runs.values()]
            entry = {"runs": len(rates), "rate": spread(rates), "contacts": median(contacts) if contacts else 0.0}
            if runs:
                last = list(runs.values())[-1]
                entry |= {"particles": last.particles, "steps": last.steps, "settings": last.settings, "searches": last.searches,
                          "seconds": median(r.seconds for r in runs.values()), "memory": max(r.memory for r in runs.values()),
                          "speed": last.speed, "others": max(r.others for r in runs.values())}
            row["codes"][code] = entry
        peers = {code: runs for code, runs in codes.items() if code != skred and runs}
        for code, runs in peers.items():
            row["ratios"][code] = spread(ratios(codes.get(skred, {}), runs))
        if peers and codes.get(skred):
            row["best_peer"] = max(peers, key=lambda code: row["codes"][code]["rate"][0])
        rows.append(row)
    return rows


def contact_problems(results, skred="Skred"):
    """Marks runs whose contacts per particle are not those of Skred's run of the same repeat (or of any, if that one failed)."""
    reference = defaultdict(dict)
    for r in results:
        if r.code == skred and not r.problems and r.contacts:
            reference[r.scene, r.processes][r.repeat] = r.contacts
    for r in results:
        of_skred = reference[r.scene, r.processes]
        if r.code == skred or r.problems or not of_skred:
            continue
        wanted = of_skred.get(r.repeat, median(of_skred.values()))
        if not abs(r.contacts / wanted - 1) <= CONTACTS_AGREE:       # not a number is wrong, too
            r.problems.append(f"{r.contacts:.3f} contacts per particle, Skred has {wanted:.3f}")


def markdown(results, trials, machine, versions, quiet, skred="Skred"):
    rows = summary(results, quiet, skred)
    codes = list(dict.fromkeys(r.code for r in results))
    peers = [code for code in codes if code != skred]
    out = [f"Machine: {machine['processor']}, {machine['processors']} processors, cache {machine['cache']}, "
           f"{machine['memory_GiB']} GiB, {machine['system']}, Linux {machine['kernel']}. Load average at the start: "
           f"{' '.join(map(str, machine['load']))}.", ""]
    out += [f"- {label}: {version}" for label, version in versions.items()]
    out += ["", "Million particle-steps per second, median (least-most). Ratio: median of the ratios within a repeat (least-most).", ""]
    head = ["scene", "particles", "threads or processes", "steps", "contacts per particle: " + ", ".join(codes), *codes,
            *(f"Skred / {code}" for code in peers), "Skred / best peer"]
    out += ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    good = group(results, quiet)
    for row in rows:
        runs = good[row["scene"], row["processes"]]
        entries = [row["codes"].get(code, {"runs": 0, "contacts": 0.0}) for code in codes]
        known = [e for e in entries if e["runs"]] or [{"particles": 0, "steps": 0}]
        cells = [row["scene"], str(known[0]["particles"]), str(row["processes"]), str(known[0]["steps"]),
                 ", ".join(f"{e['contacts']:.2f}" if e["runs"] else "-" for e in entries)]
        def star(*some):
            return "*" * any(r.others > quiet for code in some for r in runs[code].values())

        def ratio(code):
            found = ratios(runs[skred], runs[code]) if runs.get(code) and runs.get(skred) else []
            return range_text(found) + star(skred, code) if found else "-"

        cells += [range_text([r.rate / 1e6 for r in runs[code].values()]) + star(code) if code in runs else "-" for code in codes]
        cells += [ratio(code) for code in peers]
        best = row.get("best_peer")
        cells.append(f"**{ratio(best)}** {best}" if best else "-")
        out.append("| " + " | ".join(cells) + " |")
    out += ["", "Settings, searches within the timed steps, peak memory of the largest process:", "",
            "| scene | threads or processes | code | settings | timed | searches | MB |", "|---|---|---|---|---|---|---|"]
    for row in rows:
        for code, e in row["codes"].items():
            if e["runs"]:
                out.append(f"| {row['scene']} | {row['processes']} | {code} | {e['settings'] or 'its own'} | {e['seconds']:.1f} s | "
                           f"{e['searches']} | {e['memory'] / 1e6:.0f} |")
    if trials:
        out += ["", "Tried before, one run each, the fastest is used: " + "; ".join(
            f"{t.scene}, {t.code}, {t.processes}: {t.settings} {t.rate / 1e6:.2f}" + (" (failed)" if t.problems else "") for t in trials) + "."]
    out += ["", "Other programs meanwhile: on average {:.2f} processors busy, {:.2f} at most in a run; load average {:.1f} to {:.1f} "
            "at the starts.".format(sum(r.others for r in results) / max(1, len(results)), max((r.others for r in results), default=0),
                                    min((r.load for r in results), default=0), max((r.load for r in results), default=0))]
    disturbed = [r for r in results if r.others > quiet]
    if disturbed:
        used = sum(r.others > quiet for codes in good.values() for runs in codes.values() for r in runs.values())
        out.append(f"**{len(disturbed)} of {len(results)} runs were disturbed**: more than {quiet} processors were busy with other work. "
                   f"{used} of them are in the table, because no other run of that kind was made; they are marked with *.")
    bad = [r for r in [*results, *trials] if r.problems]
    if bad:
        out += ["", "Runs that failed or do not compare; none of them is in the tables:", ""]
        out += [f"- {r.scene}, {r.code}, {r.processes}, {f'repeat {r.repeat + 1}' if r.repeat >= 0 else 'tried before'}: {'; '.join(r.problems)}" for r in bad]
    return "\n".join([*out, "", DIFFERENCES, ""])
