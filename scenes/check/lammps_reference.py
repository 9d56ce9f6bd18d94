#!/usr/bin/env python3
"""The numbers of the check cases lammps-trajectories and lammps-wall, in LAMMPS's conventions: 32 spheres in a periodic cube, and one on a floor.

  lammps_reference.py                 shows that this script has LAMMPS's digits, then prints the cases' numbers (a quarter of an hour)
  lammps_reference.py --lammps lmp    the same, with LAMMPS itself beside it (29 Sep 2021 or later, package GRANULAR)

LAMMPS's conventions, `pair_style granular`: velocities half a step behind positions in all forces; a contact point at R for its
velocity and at R - overlap/2 for its torque; the spring of friction turned with the normal and kept as long as it was; where spring and
dashpot together exceed the limit both are cut to it and the spring is what is left. `alike` moves the contact point of both to R - overlap/2.
Written from the documentation of that style; nothing of skred is in it.
"""
import argparse, math, os, subprocess, tempfile

EDGE, RADIUS, MASS = 3.3591923827650145, 0.625, 1.0
INERTIA, R_EFF, M_EFF = 0.4 * MASS * RADIUS ** 2, RADIUS / 2, MASS / 2
END = 0.1                                                    # [s]
STEP = 1e-3                                                  # [s] of LAMMPS's own test

# A compressed cube of face-centred spheres, shaken: the start of LAMMPS's test of pair granular, as its dump has it.
START = """
0.01486859491041706 0.006153305490094337 3.3482642894457264
0.82408388083075079 0.83069406820625535 3.3590154773448546
0.8492587473127331 0.014596325938101153 0.83842842402834417
3.3591336383646317 0.82664674945932581 0.83998076161882329
1.6779647578335837 3.3506985693693419 0.010154526443667874
2.5279048577659506 0.84254806119276282 3.3553753797837431
2.5360855114184311 0.0032516761623658033 0.83665928898651876
1.6739468733443892 0.85607848980643808 0.82457048955826084
3.356106185605757 1.6758109256355658 0.0041423207236571695
0.83147096434453027 2.5092524086840471 3.3500637883453108
0.85611355783638388 1.6826942594783807 0.84154665017724628
0.013771982453363214 2.5031562844121731 0.82847653821219736
1.6914156976362906 1.6674002819950897 0.0012701219933282334
2.5101180276581072 2.5134207723100457 0.0093976870813241419
2.5034999249483225 1.6660302266148519 0.82501526396961888
1.6729666344903071 2.5208429361800277 0.83309884967548609
0.0058205570950049532 0.0064209096310062028 1.6649731014638345
0.84321468710252356 0.85385212345014327 1.6672323790053272
0.82594053819659896 3.3480314672029095 2.5151890883753136
0.0079059910789857444 0.8261394980206741 2.5265506758051131
1.6645718744837561 3.3559896778999887 1.6659974967883178
2.5072210491930673 0.8525970690940714 1.6692619802683291
2.5217664374751192 3.3543105949744292 2.5026648778297917
1.6883983406139866 0.83868769219362416 2.5339523505885384
0.011002368326771242 1.6728599882127233 1.6690128160049831
0.83777300669093679 2.5123422961573656 1.6690921234729301
0.84129820954967294 1.6644750152701095 2.5342830460048047
3.3456419600156333 2.5306826896894008 2.5163912695635551
1.6940110247573146 1.6847460767553577 1.667331949025747
2.5344183490004384 2.5183116762986288 1.6909796083245958
2.5269009610229962 1.6729993595302488 2.5333819012398933
1.6858614589112149 2.5090644423798061 2.5087568570691579
"""
POSITIONS = [tuple(map(float, line.split())) for line in START.split("\n") if line]

# What LAMMPS 22 Jul 2025 printed after 100 steps, by id: velocity and spin (github.com/rochi00/moose,
# modules/dem/test/tests/kokkos/lammps/dump.granular_hertz).
PRINTED = {8: ((-0.055005366950076733, 0.15341384967753857, -0.067622703315508403), (0.012856908109384564, -0.0011950078244994003, 0.0050934787725199814)),
           32: ((0.062287149161313005, -0.072044649043038853, -0.043031993406020874), (-0.0065929599765496606, 0.025533185975949252, -0.032165700844538216))}

E_MODULUS, POISSON = 4000 / 3, 1 / 3
E_EFF = E_MODULUS / (2 * (1 - POISSON ** 2))                 # [Pa] E*; G* below
G_EFF = E_MODULUS / (4 * (2 - POISSON) * (1 + POISSON))
X_T = math.sqrt(4 * G_EFF / E_EFF)                           # gamma_t / gamma_n, so that both relax alike


def tsuji(e):
    """alpha(e) of Tsuji 1992 as LAMMPS has it: gamma_n = alpha sqrt(m_eff 4/3 E* a)"""
    return 1.2728 - 4.2783 * e + 11.087 * e ** 2 - 22.348 * e ** 3 + 27.467 * e ** 4 - 18.022 * e ** 5 + 4.8218 * e ** 6


class Law:
    """One set-up: gamma_n = alpha sqrt(m_eff 4/3 E* a) of Hertz, or of springs of constant stiffness; a spring for friction and for rolling."""

    def __init__(self, name, alpha=0.0, mu=0.0, linear=0.0, k_roll=0.0, gamma_roll=0.0, mu_roll=0.0, spin=0.0, coeff=""):
        self.__dict__.update(name=name, alpha=alpha, mu=mu, linear=linear, k_roll=k_roll, gamma_roll=gamma_roll, mu_roll=mu_roll, spin=spin, coeff=coeff)

    def normal(self, overlap):
        """elastic force [N], gamma_n [kg/s], k_t [N/m]"""
        if self.linear:
            return self.linear * overlap, self.alpha * math.sqrt(self.linear * M_EFF), self.linear * X_T ** 2
        a = math.sqrt(R_EFF * overlap)
        return 4 / 3 * E_EFF * a * overlap, self.alpha * math.sqrt(M_EFF * 4 / 3 * E_EFF * a), 8 * G_EFF * a


def spins(law):
    return [[round(law.spin * math.sin(k * (c + 1.0)), 3) for c in range(3)] for k in range(1, 33)]


def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def norm(a): return math.sqrt(dot(a, a))
def add(a, b, s=1.0): return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])
def scaled(a, s): return (s * a[0], s * a[1], s * a[2])


def turned(spring, n, k, limit):
    """the spring in the tangent plane of n, as long as before; where it left the plane by nothing that counts, as it is"""
    out = dot(spring, n)
    if not abs(out) * k > 1e-10 * limit: return spring
    length, flat = norm(spring), add(spring, n, -out)
    return scaled(flat, length / norm(flat)) if norm(flat) > 0 else flat


def spring_force(spring, velocity, n, k, gamma, limit, step):
    """force of spring and dashpot within the limit, and the spring after `step` (0: as it is)"""
    if step: spring = add(turned(spring, n, k, limit), velocity, step)
    force = add(scaled(spring, -k), velocity, -gamma)
    size = norm(force)
    if size <= limit: return force, spring
    if not dot(spring, spring) > 0: return (0.0, 0.0, 0.0), spring
    force = scaled(force, limit / size)
    return force, scaled(add(force, velocity, gamma), -1 / k) if step else spring


def forces(law, x, v, w, history, step, alike):
    zero = (0.0, 0.0, 0.0)
    force, torque = [zero] * 32, [zero] * 32
    for i in range(32):
        for j in range(i + 1, 32):
            d = tuple(p - q - EDGE * round((p - q) / EDGE) for p, q in zip(x[i], x[j]))
            distance = norm(d)
            if distance >= 2 * RADIUS:
                history.pop((i, j), None)
                continue
            n, overlap = scaled(d, 1 / distance), 2 * RADIUS - distance
            elastic, gamma, k_t = law.normal(overlap)
            u = add(v[i], v[j], -1)
            normal = max(0.0, elastic - gamma * dot(u, n))
            force_ij, torque_arm, rolling = scaled(n, normal), RADIUS - overlap / 2, zero
            sliding, rolled = history.get((i, j), (zero, zero))
            couple = zero
            if law.mu:
                contact = torque_arm if alike else RADIUS
                slip = add(add(u, n, -dot(u, n)), cross(scaled(add(w[i], w[j]), contact), n), -1)
                f, sliding = spring_force(sliding, slip, n, k_t, X_T * gamma, law.mu * normal, step)
                force_ij, couple = add(force_ij, f), cross(n, f)
            if law.mu_roll:
                f, rolled = spring_force(rolled, scaled(cross(add(w[i], w[j], -1), n), R_EFF), n, law.k_roll, law.gamma_roll, law.mu_roll * normal, step)
                rolling = scaled(cross(n, f), R_EFF)
            if step: history[i, j] = (sliding, rolled)
            force[i], force[j] = add(force[i], force_ij), add(force[j], force_ij, -1)
            torque[i] = add(add(torque[i], couple, -torque_arm), rolling)
            torque[j] = add(add(torque[j], couple, -torque_arm), rolling, -1)
    return force, torque


def simulate(law, step, alike=False):
    """velocities and spins at the end, by particle"""
    x, v, w, history = list(POSITIONS), [(0.0, 0.0, 0.0)] * 32, [tuple(s) for s in spins(law)], {}
    f, t = forces(law, x, v, w, history, 0.0, alike)
    for _ in range(round(END / step)):
        v = [add(a, b, 0.5 * step / MASS) for a, b in zip(v, f)]
        w = [add(a, b, 0.5 * step / INERTIA) for a, b in zip(w, t)]
        x = [add(a, b, step) for a, b in zip(x, v)]
        f, t = forces(law, x, v, w, history, step, alike)
        v = [add(a, b, 0.5 * step / MASS) for a, b in zip(v, f)]
        w = [add(a, b, 0.5 * step / INERTIA) for a, b in zip(w, t)]
    return v, w


def run_lammps(program, scene, step, steps, count, files=()):
    """velocities and spins at the end, by particle"""
    script = (f"units lj\natom_style sphere\nnewton off\ncomm_modify vel yes\n{scene}timestep {step!r}\nfix 1 all nve/sphere\n"
              f"dump 1 all custom {steps} out.dump id vx vy vz omegax omegay omegaz\ndump_modify 1 sort id format float %.17g\nrun {steps}\n")
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (*files, ("in.lammps", script)):
            with open(os.path.join(folder, name), "w") as out: out.write(text)
        run = subprocess.run([program, "-in", "in.lammps", "-log", "none"], cwd=folder, capture_output=True, text=True)
        if run.returncode: raise SystemExit(run.stdout + run.stderr)
        with open(os.path.join(folder, "out.dump")) as dump: rows = dump.read().rstrip("\n").split("\n")[-count:]
    rows = [tuple(map(float, row.split()[1:])) for row in rows]
    return [r[:3] for r in rows], [r[3:] for r in rows]


def lammps(program, law, step):
    """the same as simulate() of LAMMPS itself"""
    data = "start\n\n32 atoms\n1 atom types\n" + "".join(f"0 {EDGE!r} {a}lo {a}hi\n" for a in "xyz") + "\nAtoms # sphere\n\n"
    data += "".join(f"{k} 1 {2 * RADIUS} 1 {p[0]!r} {p[1]!r} {p[2]!r}\n" for k, p in enumerate(POSITIONS, 1))
    data += "\nVelocities\n\n" + "".join(f"{k} 0 0 0 {s[0]!r} {s[1]!r} {s[2]!r}\n" for k, s in enumerate(spins(law), 1))
    return run_lammps(program, "boundary p p p\nread_data start.data\nset group all mass 1.0\npair_style granular\n"
                      f"pair_coeff * * {law.coeff} limit_damping\nneighbor 0.3 bin\nneigh_modify every 1 delay 0\n", step, round(END / step), 32,
                      [("start.data", data)])


def furthest(a, b):
    """greatest difference of a component of (velocities, spins)"""
    return tuple(max(abs(p - q) for s, t in zip(g, h) for p, q in zip(s, t)) for g, h in zip(a, b))


def limit_of(state_at, step):
    """the limit of vanishing steps: one step of Richardson's for a scheme of first order"""
    coarse, fine = state_at(step), state_at(step / 2)
    return tuple([tuple(2 * q - p for p, q in zip(s, t)) for s, t in zip(g, h)] for g, h in zip(coarse, fine))


def hertz(alpha_e): return f"hertz/material {E_MODULUS!r} {alpha_e!r} {POISSON!r} damping tsuji"
def mindlin(mu): return f"tangential mindlin NULL {X_T!r} {mu!r}"


LINEAR = 800.0                                               # [N/m] k_n
SET_UPS = [
    Law("normal", alpha=tsuji(0.8), coeff=hertz(0.8) + " tangential linear_nohistory 0.0 0.0"),
    Law("stick", alpha=tsuji(0.8), mu=10, spin=1.0, coeff=f"{hertz(0.8)} {mindlin(10)}"),
    Law("slide", mu=0.02, spin=1.0, coeff=f"hertz/material {E_MODULUS!r} 0.0 {POISSON!r} damping velocity {mindlin(0.02)}"),
    Law("roll", mu=10, linear=LINEAR, k_roll=LINEAR * X_T ** 2, mu_roll=0.02, spin=1.0,
        coeff=f"hooke {LINEAR!r} 0.0 damping velocity tangential linear_history {LINEAR * X_T ** 2!r} {X_T!r} 10 rolling sds {LINEAR * X_T ** 2!r} 0.0 0.02"),
]


# One sphere on the floor z = 0 ------------------------------------------------------------------------------------------

WALL_END = 0.2                                               # [s]
WALL_PRINTED = ((1.3889878724059437, 0.22220242551881125, 0.029596996643662121), (-0.31119029792475394, 2.4440485103762315, 1.0))   # dump.wall_gran


class WallLaw:
    """Springs k_n, k_t [N/m], dashpots gamma_n, gamma_t [kg/s] and mu; `limited`: the floor never pulls."""

    def __init__(self, k_n, k_t, gamma_n, gamma_t, mu, limited=True):
        self.__dict__.update(k_n=k_n, k_t=k_t, gamma_n=gamma_n, gamma_t=gamma_t, mu=mu, limited=limited)

    def coeff(self): return f"{self.k_n!r} {self.k_t!r} {self.gamma_n!r} {self.gamma_t!r} {self.mu!r} 1" + (" limit_damping" if self.limited else "")


def on_wall(law, step, alike=False):
    """velocity and spin at the end"""
    x, v, w, spring = (0.0, 0.0, 0.63), (1.0, 0.3, -2.0), (0.0, 4.0, 1.0), (0.0, 0.0, 0.0)
    up, force, torque = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for _ in range(round(WALL_END / step)):
        v, w = add(v, force, 0.5 * step / MASS), add(w, torque, 0.5 * step / INERTIA)
        x = add(x, v, step)
        overlap = RADIUS - x[2]
        if overlap > 0:
            normal = law.k_n * overlap - law.gamma_n * v[2]
            if law.limited: normal = max(0.0, normal)
            arm = RADIUS - overlap / 2 if alike else RADIUS
            slip = add(add(v, up, -v[2]), cross(w, up), -arm)
            f, spring = spring_force(spring, slip, up, law.k_t, law.gamma_t, law.mu * abs(normal), step)
            force, torque = add(f, up, normal), scaled(cross(up, f), -arm)
        else:
            spring = force = torque = (0.0, 0.0, 0.0)
        v, w = add(v, force, 0.5 * step / MASS), add(w, torque, 0.5 * step / INERTIA)
    return [v], [w]


def lammps_on_wall(program, law, step):
    """the same of LAMMPS itself"""
    steps = round(WALL_END / step)
    return run_lammps(program, "boundary p p f\nregion box block -5 5 -5 5 0 5\ncreate_box 1 box\ncreate_atoms 1 single 0 0 0.63\n"
                      f"set group all diameter {2 * RADIUS}\nset group all mass 1.0\nvelocity all set 1 0.3 -2\nset group all omega 0 4 1\n"
                      f"pair_style none\ncomm_modify cutoff 2\nfix 2 all wall/gran hooke/history {law.coeff()} zplane 0.0 NULL\n", step, steps, 1)


K_T = 1000 * 6 / 7                                           # of nu = 1/4
WALL_SET_UPS = [WallLaw(1000.0, K_T, 0.0, 0.0, 10.0), WallLaw(1000.0, K_T, 0.0, 0.0, 0.2)]


def digits_of_lammps():
    """greatest distance of this script from what LAMMPS 22 Jul 2025 printed of its own test"""
    # gamma_n of `coeff_restitution` at e = 0.8, -2 sqrt(5/6) ln e / sqrt(pi^2 + ln^2 e) sqrt(2 E* a m_eff), in terms of alpha
    log_e = math.log(0.8)
    alpha = -2 * math.sqrt(5 / 6) * log_e / math.sqrt(math.pi ** 2 + log_e ** 2) * math.sqrt(1.5)
    own_test = Law("printed", alpha=alpha, mu=0.5, k_roll=500, gamma_roll=50, mu_roll=0.1)
    state = simulate(own_test, STEP)
    return max(abs(p - q) for k, pair in PRINTED.items() for of, given in zip(state, pair) for p, q in zip(of[k - 1], given))


COMPONENTS = ("vx", "vy", "vz", "wx", "wy", "wz")


def wall_numbers(program):
    state = on_wall(WallLaw(1000.0, 500.0, 50.0, 50.0, 0.4, limited=False), STEP)
    print(f"wall, from what LAMMPS printed: {max(abs(p - q) for of, given in zip(state, WALL_PRINTED) for p, q in zip(of[0], given)):.1e}")
    columns = {"lim": [], "same": []}
    for law in WALL_SET_UPS:
        if program: print(f"wall: LAMMPS from this script at {STEP} s: {furthest(lammps_on_wall(program, law, STEP), on_wall(law, STEP))}")
        for name, alike in (("lim", False), ("same", True)):
            v, w = limit_of(lambda h: on_wall(law, h, alike), STEP / 64)
            columns[name].append(v[0] + w[0])
    for name, (hold, slide) in columns.items():
        for k, component in enumerate(COMPONENTS): print(f'    {component}_{name}: "set_up == 0 ? {hold[k]:.9g} : {slide[k]:.9g}"')


def main():
    options = argparse.ArgumentParser(description="The numbers of the check cases lammps-trajectories and lammps-wall.")
    options.add_argument("--lammps", metavar="PROGRAM", help="run LAMMPS too")
    program = options.parse_args().lammps

    wall_numbers(program)
    print(f"from what LAMMPS printed: {digits_of_lammps():.1e}")
    columns = {"step": [], "lim": [], "same": []}            # as the case names them
    for law in SET_UPS:
        at_step, limit = simulate(law, STEP), limit_of(lambda h: simulate(law, h), STEP / 32)
        if program:
            print(f"{law.name}: LAMMPS from this script at {STEP} s: {furthest(lammps(program, law, STEP), at_step)}, "
                  f"for vanishing steps: {furthest(limit_of(lambda h: lammps(program, law, h), STEP / 128), limit)}")
        alike = limit_of(lambda h: simulate(law, h, True), STEP / 32) if law.mu else limit
        for name, (v, w) in zip(columns, (at_step, limit, alike)): columns[name].append(v[7] + w[7])      # of particle 8
    for name, of_set_up in columns.items():
        for k, component in enumerate(COMPONENTS):
            n, s, f, r = (f"{state[k]:.9g}" for state in of_set_up)
            print(f'    {component}_{name}: "set_up == 0 ? {n} : set_up == 1 ? {s} : set_up == 2 ? {f} : {r}"')


if __name__ == "__main__":
    main()
