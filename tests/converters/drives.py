"""Three-phase converters and machines: their netlists and, by hand, their equations."""

import math

from cases import Case
from control import PI
from events import Circuit, Clock

TURN = 2 * math.pi
THIRD = TURN / 3
ROOT = 1 / math.sqrt(3)


def to_dq(phases, angle):
    """(d, q) of three phases, with the amplitude kept; phase k lags by k thirds of a turn."""
    a, b, c = phases
    alpha, beta = (2 * a - b - c) / 3, (b - c) * ROOT
    turned, across = math.cos(angle), math.sin(angle)
    return alpha * turned + beta * across, beta * turned - alpha * across


def card_dq(name, signals, angle):
    """Two B sources, of nodes named NAMEd and NAMEq."""
    lags = ["", f"-{THIRD!r}", f"-{2 * THIRD!r}"]
    return "".join(f"b{name}{axis} {name}{axis} 0 V={sign}2/3*(" +
                   "+".join(f"{s}*{function}({angle}{lag})" for s, lag in zip(signals, lags)) + ")\n"
                   for axis, sign, function in (("d", "", "cos"), ("q", "-", "sin")))


def to_phases(d, q, angle):
    turned, across = math.cos(angle), math.sin(angle)
    alpha, beta = d * turned - q * across, 1.5 * ROOT * (d * across + q * turned)
    return [alpha, beta - 0.5 * alpha, -beta - 0.5 * alpha]


def card_phases(d, q, angle, high):
    """Nodes ma, mb, mc: what a triangle from -1 to 1 is compared with, for space vectors: the middle of the highest and
    the lowest is taken away."""
    text = ""
    for k, p in enumerate("abc"):
        at = f"{angle}-{k * THIRD!r}" if k else angle
        text += f"bu{p} u{p} 0 V=({d}*cos({at})-{q}*sin({at}))/({high})\n"
    text += "bu0 u0 0 V=0.5*(max(v(ua),max(v(ub),v(uc)))+min(v(ua),min(v(ub),v(uc))))\n"
    return text + "".join(f"em{p} m{p} 0 VALUE={{v(u{p})-v(u0)}}\n" for p in "abc")


def balanced(u):
    middle = 0.5 * (max(u) + min(u))
    return [v - middle for v in u]


def triangle(t, period):
    """From -1 up to 1 in half a period and back."""
    turn = t / period
    turn -= math.floor(turn)
    return 4 * turn - 1 if turn < 0.5 else 3 - 4 * turn


def card_bridge(plus, minus):
    """Legs from ma, mb, mc at a triangle; outputs a, b, c."""
    return "".join(f"s{p}h {plus} {p} m{p} tri sm\ns{p}l {p} {minus} tri m{p} sm\n" for p in "abc") + ".model sm sw\n"


class ThreePhase(Circuit):
    """Modes: (legs, limits of the integrators). A leg is True where its modulation is above the triangle."""

    def __init__(self, period):
        self.period, self.step = period, period / 5
        self.clock = Clock(period / 2, [0.0])
        self.controllers = []  # (PI, place of its state)

    def errors(self, t, x):
        """Inputs of the controllers, in their order."""
        raise NotImplementedError

    def modulation(self, t, x):
        raise NotImplementedError

    def start(self, x):
        wanted = self.modulation(0.0, x)
        return (tuple(m > -1.0 for m in wanted), tuple([0] * len(self.controllers)))

    def guards(self, t, x, mode):
        legs, held = mode
        tri = triangle(t, self.period)
        found = [tri - m if leg else m - tri for leg, m in zip(legs, self.modulation(t, x))]
        for (pi, place), e, h in zip(self.controllers, self.errors(t, x), held):
            found += pi.guards(e, x[place], h)
        return found

    def ends(self, t, x, mode, which):
        legs, held = list(mode[0]), list(mode[1])
        if which < 3:
            legs[which] = not legs[which]
        else:
            n = (which - 3) // 2
            pi, place = self.controllers[n]
            held[n], x = pi.ends(x, place, held[n], (which - 3) % 2)
        return (tuple(legs), tuple(held)), x

    def next_edge(self, t, mode):
        return self.clock.after(t)


# ---- Inverter with a current controller ------------------------------------------------------------------

class Inverter(ThreePhase):
    """At coils, resistors and a three-phase source without a neutral. States: two currents, two integrals."""

    def __init__(self, volts, coil, ohms, back, hertz, period, wanted, gains):
        super().__init__(period)
        self.volts, self.coil, self.ohms, self.back, self.omega = volts, coil, ohms, back, TURN * hertz
        self.wanted = wanted  # d, q before and after, the time of the step
        self.controllers = [(PI(*gains), 2), (PI(*gains), 3)]
        self.changes = Clock(1e9, [wanted[2]])

    def errors(self, t, x):
        d, q = to_dq([x[0], x[1], -x[0] - x[1]], self.omega * t)
        before, after, when = self.wanted
        return [before - d, (after if t >= when * (1 - 1e-12) else 0.0) - q]

    def modulation(self, t, x):
        d, q = to_dq([x[0], x[1], -x[0] - x[1]], self.omega * t)
        u = [pi.output(e, x[place]) for (pi, place), e in zip(self.controllers, self.errors(t, x))]
        u = (u[0] - self.omega * self.coil * q, u[1] + self.omega * self.coil * d)
        return balanced([v / (self.volts / 2) for v in to_phases(*u, self.omega * t)])

    def derivative(self, t, x, mode):
        legs, held = mode
        middle = sum(legs) / 3
        current = [x[0], x[1]]
        back = to_phases(self.back, 0.0, self.omega * t)
        rates = [(self.volts * (legs[k] - middle) - back[k] - self.ohms * current[k]) / self.coil for k in range(2)]
        return rates + [pi.rate(e, h) for (pi, _), e, h in zip(self.controllers, self.errors(t, x), held)]

    def next_edge(self, t, mode):
        return min(self.clock.after(t), self.changes.after(t))


def svpwm(rows=None):
    for k, (volts, hertz, switching, amperes, part, periods) in enumerate(rows or [
            (600, 50, 5e3, 10, 0.6, 1), (48, 400, 40e3, 30, 0.8, 1), (3e3, 16.7, 1.2e3, 200, 0.75, 1.2)]):
        period = 1 / switching
        back = part * volts / math.sqrt(3) * 0.8
        coil, ohms = volts * period / 6 / (0.3 * amperes), 0.03 * volts / amperes
        gains = (coil * switching / 4, coil * switching ** 2 / 40, -volts, volts)
        when = 0.4 / hertz
        circuit = Inverter(volts, coil, ohms, back, hertz, period, (amperes, -0.5 * amperes, when), gains)
        w = f"{TURN * hertz!r}*time"
        text = f"vdc p 0 {volts!r}\n{card_bridge('p', '0')}"
        text += "".join(f"l{p} {p} y{p} {coil!r}\nr{p} y{p} e{p} {ohms!r}\n"
                        f"v{p} e{p} n sin(0 {back!r} {hertz!r} 0 0 {90 - 120 * n})\n" for n, p in enumerate("abc"))
        text += f"vt tri 0 pulse(-1 1 0 {period / 2!r} {period / 2!r} 0 {period!r})\n"
        text += card_dq("i", ["i(la)", "i(lb)", "i(lc)"], w)
        text += f"bed ed 0 V={amperes!r}-v(id)\nvq wq 0 pulse(0 {-0.5 * amperes!r} {when!r})\nbeq eq 0 V=v(wq)-v(iq)\n"
        text += circuit.controllers[0][0].card("d", "ed pd") + circuit.controllers[1][0].card("q", "eq pq")
        cross = TURN * hertz * coil
        text += f"bd ud 0 V=v(pd)-{cross!r}*v(iq)\nbq uq 0 V=v(pq)+{cross!r}*v(id)\n"
        text += card_phases("v(ud)", "v(uq)", w, repr(volts / 2)) + ".lib control.lib\n"
        x = [0.0] * 4
        yield Case(f"svpwm_{k}", text, circuit, x, circuit.start(x), periods / hertz,
                   {"i(la)": lambda x: x[0], "i(lb)": lambda x: x[1], "i(lc)": lambda x: -x[0] - x[1],
                    "v(xd.x)": lambda x: x[2], "v(xq.x)": lambda x: x[3]}, 1e-9)


# ---- Rectifier with a phase-locked loop ------------------------------------------------------------------

class ActiveRectifier(ThreePhase):
    """States: two currents into the bridge, its capacitor, the loop's angle and integral, the integrals of the
    controllers of the voltage and of the currents d and q."""

    def __init__(self, peak, hertz, coil, ohms, store, load, period, wanted, phase, loop, outer, inner):
        super().__init__(period)
        self.peak, self.omega, self.coil, self.ohms, self.store, self.load = peak, TURN * hertz, coil, ohms, store, load
        self.wanted, self.phase, self.loop = wanted, phase, loop
        self.controllers = [(outer, 5), (inner, 6), (inner, 7)]

    def sources(self, t):
        return to_phases(self.peak, 0.0, self.omega * t + self.phase)

    def currents(self, x):
        return to_dq([x[0], x[1], -x[0] - x[1]], x[3])

    def errors(self, t, x):
        e = self.wanted - x[2]
        d, q = self.currents(x)
        return [e, self.controllers[0][0].output(e, x[5]) - d, -q]

    def modulation(self, t, x):
        e = self.errors(t, x)
        d, q = self.currents(x)
        inner = self.controllers[1][0]
        across = self.omega * self.coil
        u = (self.peak - inner.output(e[1], x[6]) + across * q, -inner.output(e[2], x[7]) - across * d)
        return balanced([v / (x[2] / 2) for v in to_phases(*u, x[3])])

    def derivative(self, t, x, mode):
        legs, held = mode
        e = self.sources(t)
        middle = sum(legs) / 3
        current = [x[0], x[1], -x[0] - x[1]]
        rates = [(e[k] - self.ohms * current[k] - x[2] * (legs[k] - middle)) / self.coil for k in range(2)]
        rates.append((sum(i for i, leg in zip(current, legs) if leg) - x[2] / self.load) / self.store)
        _, q = to_dq(e, x[3])
        rates += [self.omega + self.loop[0] * q + x[4], self.loop[1] * q]
        return rates + [pi.rate(err, h) for (pi, _), err, h in zip(self.controllers, self.errors(t, x), held)]


def active_rectifier(rows=None):
    for k, (peak, hertz, wanted, power, switching, phase, periods) in enumerate(rows or [
            (325, 50, 700, 5e3, 5e3, 0.5, 0.4), (170, 400, 400, 1e3, 48e3, -1.2, 0.5), (30, 60, 80, 200, 8e3, 1.9, 0.5)]):
        period = 1 / switching
        amperes = 2 * power / (3 * peak)
        coil, ohms = wanted * period / 6 / (0.4 * amperes), 0.02 * peak / amperes
        store, load = 0.6 * power / (hertz * wanted ** 2), wanted ** 2 / power
        loop = (0.8 * TURN * hertz / peak, 0.3 * (TURN * hertz) ** 2 / peak)
        outer = PI(0.05 * amperes / (0.02 * wanted), 0.05 * amperes * hertz / (0.02 * wanted), 0.0, 2 * amperes, amperes)
        inner = PI(coil * switching / 4, coil * switching ** 2 / 40, -wanted, wanted)
        circuit = ActiveRectifier(peak, hertz, coil, ohms, store, load, period, wanted, phase, loop, outer, inner)
        start = 0.97 * wanted
        text = "".join(f"v{p} s{p} 0 sin(0 {peak!r} {hertz!r} 0 0 {90 + math.degrees(phase) - 120 * n!r})\n"
                       f"r{p} s{p} y{p} {ohms!r}\nl{p} y{p} {p} {coil!r}\n" for n, p in enumerate("abc"))
        text += card_bridge("p", "n") + f"c1 p n {store!r} ic={start!r}\nr1 p n {load!r}\n"
        text += f"vt tri 0 pulse(-1 1 0 {period / 2!r} {period / 2!r} 0 {period!r})\n"
        text += card_dq("v", ["v(sa)", "v(sb)", "v(sc)"], "v(th)") + card_dq("i", ["i(la)", "i(lb)", "i(lc)"], "v(th)")
        text += f"* the loop\naint vq x pll\n.model pll int(gain={loop[1]!r} out_lower_limit=-1e9 out_upper_limit=1e9)\n" \
                f"bth 0 th I={TURN * hertz!r}+{loop[0]!r}*v(vq)+v(x)\ncth th 0 1 ic=0\n"
        text += f"bv ev 0 V={wanted!r}-v(p,n)\n{outer.card('v', 'ev wd')}bed ed 0 V=v(wd)-v(id)\nbeq eq 0 V=-v(iq)\n"
        text += inner.card("d", "ed pd") + inner.card("q", "eq pq")
        across = TURN * hertz * coil
        text += f"bd ud 0 V={peak!r}-v(pd)+{across!r}*v(iq)\nbq uq 0 V=-v(pq)-{across!r}*v(id)\n"
        text += card_phases("v(ud)", "v(uq)", "v(th)", "v(p,n)/2") + ".lib control.lib\n"
        x = [0.0, 0.0, start, 0.0, 0.0, outer.ic, 0.0, 0.0]
        yield Case(f"active_rectifier_{k}", text, circuit, x, circuit.start(x), periods / hertz,
                   {"i(la)": lambda x: x[0], "i(lb)": lambda x: x[1], "v(p,n)": lambda x: x[2], "v(th)": lambda x: x[3],
                    "v(x)": lambda x: x[4], "v(xv.x)": lambda x: x[5], "v(xd.x)": lambda x: x[6],
                    "v(xq.x)": lambda x: x[7]}, 1e-9)


# ---- Induction machine on an inverter --------------------------------------------------------------------

class Machine(Circuit):
    """In coordinates of the stator: its flux and that of the rotor (alpha, beta), the mechanical speed. The mode is the
    legs of the inverter: of six steps, or where a sine is above a triangle."""

    def __init__(self, volts, hertz, stator, rotor, pairs, inertia, drag, depth=None, period=None):
        self.volts, self.omega, self.stator, self.rotor, self.pairs = volts, TURN * hertz, stator, rotor, pairs
        self.inertia, self.drag, self.depth, self.period = inertia, drag, depth, period
        self.clock = Clock(period / 2, [0.0]) if depth else Clock(1 / hertz, [k / hertz / 6 for k in range(6)])
        self.step = (period or 1 / hertz / 6) / 5
        self.scales = [volts / self.omega] * 4 + [self.omega / pairs]

    def currents(self, x):
        (_, own, _), (_, other, mutual) = self.stator, self.rotor
        whole = own * other - mutual * mutual
        return [(other * x[k] - mutual * x[k + 2]) / whole for k in range(2)] + \
            [(own * x[k + 2] - mutual * x[k]) / whole for k in range(2)]

    def derivative(self, t, x, mode):
        a, b, c = (self.volts * leg for leg in mode)
        i = self.currents(x)
        speed = self.pairs * x[4]
        torque = 1.5 * self.pairs * (x[0] * i[1] - x[1] * i[0])
        return [(2 * a - b - c) / 3 - self.stator[0] * i[0], (b - c) / math.sqrt(3) - self.stator[0] * i[1],
                -self.rotor[0] * i[2] - speed * x[3], -self.rotor[0] * i[3] + speed * x[2],
                (torque - self.drag * x[4] * abs(x[4])) / self.inertia]

    def guards(self, t, x, mode):
        if not self.depth:
            return []
        tri = triangle(t, self.period)
        wave = [self.depth * math.sin(self.omega * t - k * THIRD) for k in range(3)]
        return [tri - w if leg else w - tri for leg, w in zip(mode, wave)]

    def ends(self, t, x, mode, which):
        return tuple(leg != (k == which) for k, leg in enumerate(mode)), x

    def next_edge(self, t, mode):
        return self.clock.after(t)

    def legs(self, t):
        """Of six steps: the sines' signs just after t."""
        turn = self.omega * (t + 1e-6 * self.step)
        return tuple(math.sin(turn - k * THIRD) > 0 for k in range(3))

    def edge(self, t, x, mode):
        return (mode if self.depth else self.legs(t)), x


def machine(rows=None):
    for k, (volts, hertz, power, pairs, depth, switching, periods) in enumerate(rows or [
            (540, 50, 4e3, 2, None, None, 6), (540, 50, 4e3, 2, 0.9, 3e3, 2), (48, 100, 300, 1, None, None, 8),
            (3e3, 60, 500e3, 3, 0.8, 1.5e3, 3)]):
        # per unit of impedance: resistances, leakages and the mutual inductance
        unit = 1.5 * (volts / 2) ** 2 / power
        mutual = 2.2 * unit / (TURN * hertz)
        leak = 0.09 * unit / (TURN * hertz)
        stator, rotor = (0.035 * unit, mutual + leak, mutual), (0.04 * unit, mutual + 1.2 * leak, mutual)
        speed = TURN * hertz / pairs
        inertia, drag = power * 0.06 / speed ** 2 * 0.5, 0.6 * power / speed ** 3
        circuit = Machine(volts, hertz, stator, rotor, pairs, inertia, drag, depth, 1 / switching if switching else None)
        whole = stator[1] * rotor[1] - mutual ** 2
        text = f"vdc p 0 {volts!r}\n"
        if depth:
            text += card_bridge("p", "0")
            text += f"vt tri 0 pulse(-1 1 0 {0.5 / switching!r} {0.5 / switching!r} 0 {1 / switching!r})\n"
            text += "".join(f"vm{p} m{p} 0 sin(0 {depth!r} {hertz!r} 0 0 {-120 * n})\n" for n, p in enumerate("abc"))
        else:
            text += "".join(f"s{p}h p {p} m{p} 0 sm\ns{p}l {p} 0 0 m{p} sm\n" for p in "abc") + ".model sm sw\n"
            text += f"va ma 0 pulse(-1 1 0 0 0 {0.5 / hertz!r} {1 / hertz!r})\n" \
                    f"vb mb 0 pulse(-1 1 {1 / hertz / 3!r} 0 0 {0.5 / hertz!r} {1 / hertz!r})\n" \
                    f"vc mc 0 pulse(1 -1 {1 / hertz / 6!r} 0 0 {0.5 / hertz!r} {1 / hertz!r})\n"
        text += "".join(f"bis{n} is{n} 0 V=({rotor[1]!r}*v(ps{n})-{mutual!r}*v(pr{n}))/{whole!r}\n"
                        f"bir{n} ir{n} 0 V=({stator[1]!r}*v(pr{n})-{mutual!r}*v(ps{n}))/{whole!r}\n"
                        f"cs{n} ps{n} 0 1 ic=0\ncr{n} pr{n} 0 1 ic=0\n" for n in "ab")
        text += f"bsa 0 psa I=(2*v(a)-v(b)-v(c))/3-{stator[0]!r}*v(isa)\n" \
                f"bsb 0 psb I=(v(b)-v(c))/{math.sqrt(3)!r}-{stator[0]!r}*v(isb)\n" \
                f"bra 0 pra I=-{rotor[0]!r}*v(ira)-{pairs}*v(w)*v(prb)\n" \
                f"brb 0 prb I=-{rotor[0]!r}*v(irb)+{pairs}*v(w)*v(pra)\n" \
                f"bt t 0 V={1.5 * pairs!r}*(v(psa)*v(isb)-v(psb)*v(isa))\n" \
                f"bw 0 w I=v(t)-{drag!r}*v(w)*abs(v(w))\ncw w 0 {inertia!r} ic=0\n" \
                f"* what the machine takes from the inverter\n" \
                f"bpa a 0 I=v(isa)\nbpb b 0 I={math.sqrt(3) / 2!r}*v(isb)-v(isa)/2\n" \
                f"bpc c 0 I=-{math.sqrt(3) / 2!r}*v(isb)-v(isa)/2\n"
        yield Case(f"machine_{k}", text, circuit, [0.0] * 5,
                   tuple(m > -1.0 for m in (0.0, -depth * math.sin(THIRD), depth * math.sin(THIRD))) if depth else
                   circuit.legs(0.0), periods / hertz,
                   {f"v({name})": (lambda x, n=n: x[n]) for n, name in enumerate(("psa", "psb", "pra", "prb", "w"))} |
                   {"v(isa)": lambda x, c=circuit: c.currents(x)[0]}, 1e-9)
