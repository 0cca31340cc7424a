#!/usr/bin/env python3
"""Runs in which Python gives external sources their values, and runs that start with given states.

Against closed forms, and against netlists in which what was given stands as PWL.

usage: cosimulation.py SOURCE_FOLDER, with PYTHONPATH=build/src/python
"""

import math
import sys
import unittest

import numpy as np

import dalcs

FILTER = """A capacitor that a program charges
V1 in 0 EXTERNAL
R1 in out 1k
C1 out 0 1u
.tran 10u 5m
.end
"""
BUCK = """A buck converter whose switch and load a program drives
Vin in 0 12
Vg g 0 0 EXTERNAL
S1 in sw g 0 sm
D1 0 sw dm
L1 sw out 50u
C1 out 0 20u
R1 out 0 {load}
.param load=2
I1 out 0 0.25 EXTERNAL
.model sm SW(Ron=10m Vt=0.5)
.model dm D(Ron=10m Vfwd=0.4)
.tran 1u 1m uic
.meas tran vavg avg v(out) from=0.5m
.meas tran ipk max i(l1)
.end
"""
GATES = """An inverter between two programs' sources
V1 in 0 EXTERNAL
A1 in 0 0 0 0 out 0 0 INV Td=1u
R1 out 0 1k
.tran 1u 1m
.options dialect=ltspice
.end
"""

READERS = """Formulas of nothing but what a program gives
V1 in 0 EXTERNAL
B1 double 0 V=2*v(in)
B2 cut 0 V=limit(v(in)-1, 0, 3)
B3 bit 0 V=v(in) > 2.5 ? 1 : 0
R1 double 0 1k
.tran 10u 1m
.end
"""


class Hysteretic:
    """Below 5 V on, else off; the load steps in the middle. It notes what it gave."""

    def __init__(self, every):
        self.every = every
        self.given = []

    def __call__(self, time, signals, inputs):
        inputs["vg"] = 1.0 if signals.get("v(out)", 0.0) < 5.0 else 0.0
        inputs["i1"] = 1.0 if time > 0.5e-3 else 0.25
        self.given.append((time, inputs["vg"], inputs["i1"]))
        return self.every * len(self.given)

    def written(self, netlist):
        """The same netlist without a program."""
        for column, card in ((1, "Vg g 0 0 EXTERNAL"), (2, "I1 out 0 0.25 EXTERNAL")):
            points = [(0.0, self.given[0][column])]
            for step in self.given:
                if step[column] != points[-1][1]:
                    points += [(step[0], points[-1][1]), (step[0], step[column])]
            course = " ".join(f"{time!r} {value!r}" for time, value in points)
            netlist = netlist.replace(card, f"{card.split(' ', 3)[0]} {' '.join(card.split()[1:3])} PWL({course})")
        return netlist


class Exchanges(unittest.TestCase):
    def test_against_the_closed_form(self):
        """At times that lie on no grid, with levels that a step of any method has to end at."""
        for method, allowed in ("auto", 1e-9), ("lobatto", 1e-9), ("euler", 2e-3):
            draw = np.random.default_rng(7)
            state = {"t": 0.0, "x": 3.0, "u": 3.0, "n": 0, "worst": 0.0}

            def exchange(time, signals, inputs, state=state, draw=draw):
                if not signals:
                    self.assertEqual((time, inputs), (0.0, {"v1": 0.0}))
                else:
                    self.assertEqual(set(signals), {"v(in)", "v(out)", "i(v1)"})
                    state["x"] = state["u"] + (state["x"] - state["u"]) * math.exp(-(time - state["t"]) / 1e-3)
                    state["worst"] = max(state["worst"], abs(signals["v(out)"] - state["x"]))
                    self.assertEqual(signals["v(in)"], state["u"])  # before it jumps
                    state["u"] = float(draw.uniform(-5.0, 5.0))
                inputs["v1"] = state["u"]
                state.update(t=time, n=state["n"] + 1)
                return time + float(draw.uniform(1e-5, 4e-4))

            dalcs.run(FILTER, exchange=exchange, method=method, **({"step": 1e-6} if method == "euler" else {}))
            self.assertGreater(state["n"], 15)
            self.assertLess(state["worst"], allowed)

    def test_against_what_was_given_in_the_netlist(self):
        for every in 1e-6, 3.7e-6, 2.5e-5:
            for options in {}, {"tol": 1e-9}, {"audit": "full"}, {"energy": True, "losses": True}:
                program = Hysteretic(every)
                found = dalcs.run(BUCK, exchange=program, **options)
                wanted = dalcs.run(program.written(BUCK), **options)
                self.assertGreater(len(program.given), 39)
                for name, value in wanted.measures.items():
                    self.assertAlmostEqual(found.measures[name], value, delta=1e-9)
                self.assertEqual(found.events["element"].tolist(), wanted.events["element"].tolist())
                np.testing.assert_allclose(found.events["time"], wanted.events["time"], rtol=0, atol=1e-12)
                for name, value in wanted.report["final"].items():
                    self.assertAlmostEqual(found.report["final"][name], value, delta=1e-9)

    def test_an_exchange_without_a_change_is_no_event(self):
        often = dalcs.run(FILTER, exchange=lambda time, _, inputs: inputs.update(v1=1.0) or time + 1e-6)
        once = dalcs.run(FILTER, exchange=lambda time, _, inputs: inputs.update(v1=1.0))
        self.assertEqual(len(often), len(once))
        self.assertEqual(often.report["work"]["steps"], once.report["work"]["steps"])

    def test_formulas_see_what_is_given(self):
        for method in ("auto", "euler"):
            found = dalcs.run(READERS, exchange=lambda time, _, inputs: inputs.update(v1=5e3 * time) or time + 1e-4,
                              method=method)
            given = np.asarray(found["v(in)"])
            self.assertGreater(given[-1], 4.0)
            np.testing.assert_allclose(found["v(double)"], 2 * given, rtol=0, atol=1e-9)
            np.testing.assert_allclose(found["v(cut)"], np.clip(given - 1, 0, 3), rtol=0, atol=1e-9)
            apart = np.abs(given - 2.5) > 1e-9
            np.testing.assert_allclose(np.asarray(found["v(bit)"])[apart], (given > 2.5)[apart], rtol=0, atol=1e-9)

    def test_steps_are_the_same_run(self):
        program = Hysteretic(1e-5)
        whole = dalcs.run(BUCK, exchange=program)
        with dalcs.Circuit(BUCK).start() as run:
            self.assertEqual((run.time, run.inputs, dict(run.signals)), (0.0, {"vg": 0.0, "i1": 0.25}, {}))
            for time, vg, load in program.given:
                self.assertIsNone(run.result)
                self.assertEqual(run.time, time)
                run.step(1e-5 * (1 + round(time / 1e-5)), vg=vg, i1=load)
            while run.result is None:
                run.step(1.0)
            np.testing.assert_array_equal(run.result.values, whole.values)
            self.assertEqual(run.signals["v(out)"], whole["v(out)"][-1])
            with self.assertRaisesRegex(ValueError, "come to its end"):
                run.step(1.0)
        with dalcs.Circuit(BUCK).start({"load": 3}) as run:
            run.step(1e-4, vg=1)
            with self.assertRaisesRegex(ValueError, "cannot go to 5e-05 s"):
                run.step(5e-5)
            with self.assertRaisesRegex(KeyError, "no external source 'v1' among vg, i1"):
                run.step(2e-4, v1=3)
        with self.assertRaisesRegex(ValueError, "was closed"):
            run.step(2e-4)

    def test_each_step_of_a_netlist_begins_anew(self):
        programs = []

        def exchange(time, signals, inputs):
            if not signals:
                programs.append(Hysteretic(1e-5))
            return programs[-1](time, signals, inputs)

        netlist = BUCK.replace(".end", ".options dialect=ltspice\n.end")
        found = dalcs.run(netlist.replace(".end", ".step param load list 2 3\n.end"), exchange=exchange)
        self.assertEqual(len(programs), 2)
        for program, table, load in zip(programs, found.tables, (2, 3)):
            wanted = dalcs.run(program.written(netlist), load=load)
            self.assertAlmostEqual(table["v(out)"][-1], wanted["v(out)"][-1], delta=1e-9)

    def test_beside_gates(self):
        levels = []

        def exchange(time, signals, inputs):
            if signals and time > 1e-4:
                levels.append((inputs["v1"], signals["v(out)"]))
            inputs["v1"] = float(round(time / 1e-4) % 2)
            return time + 1e-4

        dalcs.run(GATES, exchange=exchange, audit="full")
        self.assertGreater(len(levels), 7)
        self.assertEqual({(1.0, 0.0), (0.0, 1.0)}, {(round(a, 9), round(b, 9)) for a, b in levels})

    def test_what_goes_wrong(self):
        def silent(_time, _signals, _inputs):
            return None

        for exchange, kind, text in (
                (lambda time, _, __: time, dalcs.OptionError, "asks for one at 0 s, which is not later"),
                (lambda _, __, inputs: inputs.update(v1=math.nan), dalcs.OptionError, "gives 'v1' the value"),
                (lambda _, __, inputs: inputs.update(v2=1.0), KeyError, "no external source 'v2' among v1"),
                (lambda _, __, ___: 1 / 0, ZeroDivisionError, "division")):
            with self.assertRaisesRegex(kind, text):
                dalcs.run(FILTER, exchange=exchange)
        with self.assertRaisesRegex(dalcs.NetlistError, "'v1' is external: its values come from a program") as caught:
            dalcs.run(FILTER)
        self.assertEqual((caught.exception.element, caught.exception.line), ("v1", 2))
        with self.assertRaisesRegex(dalcs.OptionError, "no external source"):
            dalcs.run(FILTER.replace("EXTERNAL", "1"), exchange=silent)
        with self.assertRaisesRegex(dalcs.NetlistError, "what it will do is not known"):
            dalcs.run(FILTER.replace(".tran 10u 5m", ".pss"), exchange=silent)
        with self.assertRaisesRegex(dalcs.NetlistError, "cannot be several in parallel"):
            dalcs.run(FILTER.replace("V1 in 0 EXTERNAL", ".subckt s a\nI1 0 a EXTERNAL\n.ends\nX1 in s m=2"),
                      exchange=silent)
        self.assertEqual(dalcs.run(FILTER.replace(".tran 10u 5m", ".op").replace("EXTERNAL", "3 external"))["v(out)"][0],
                         3.0)


class States(unittest.TestCase):
    def test_a_run_goes_on(self):
        """Whole periods of the source, so that it is at its end what it was at the start."""
        netlist = """A rectifier with a choke
.param t=100m
V1 in 0 SIN(0 10 50)
D1 in a
L1 a out 10m
C1 out 0 100u
R1 out 0 100
.tran 100u {t} uic
"""
        whole = dalcs.run(netlist, tol=1e-10)
        half = dalcs.run(netlist, t=0.04, tol=1e-10)
        rest = dalcs.run(netlist, t=0.06, tol=1e-10, initial=half.report["final"])
        for name, value in whole.report["final"].items():
            self.assertAlmostEqual(rest.report["final"][name], value, delta=1e-8)

    def test_without_uic(self):
        netlist = FILTER.replace("EXTERNAL", "1")
        found = dalcs.run(netlist, initial={"C1": "250m"})
        np.testing.assert_allclose(found["v(out)"], 1.0 - 0.75 * np.exp(-found.t / 1e-3), atol=1e-9)
        with self.assertRaisesRegex(dalcs.OptionError, "no capacitor and no coil 'r1'"):
            dalcs.run(netlist, initial={"r1": 1.0})
        with self.assertRaisesRegex(dalcs.OptionError, "cannot be nan"):
            dalcs.run(netlist, initial={"c1": math.nan})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
