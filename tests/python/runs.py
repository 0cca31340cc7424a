#!/usr/bin/env python3
"""Runs from Python: values against closed forms, what errors carry, what a result gives.

usage: runs.py SOURCE_FOLDER, with PYTHONPATH=build/src/python
"""

import copy
import gc
import math
import os
import pathlib
import pickle
import signal
import sys
import tempfile
import threading
import unittest

import numpy as np

import dalcs
from half_wave import NETLIST, closes, opens, output

SOURCE = pathlib.Path(sys.argv[1])
BOOST = """Boost converter with a large output capacitor
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
L1 in sw 50u
S1 sw 0 g 0 sm
D1 sw out
C1 out 0 10m
R1 out 0 100
.model sm SW(Ron=10m Vt=0.5)
.pss uic
"""
ENDLESS = SOURCE / "netlists" / "converters" / "buck_closed_loop.cir"


def has(module):
    try:
        __import__(module)
    except ImportError:
        return False
    return True


STEPS = """A rectifier with a load that shorts it in one step
.options dialect=ltspice
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 10u
R1 out 0 {load}
.param load=1k
.step param load list 1k 0 4.7k
.tran 10u 20m uic
.meas tran vlow min v(out) from=10m
.end
"""


class Failures(unittest.TestCase):
    def test_a_step_that_fails_loses_none_of_the_others(self):
        with self.assertRaises(dalcs.NoSolution) as caught:
            dalcs.run(STEPS)
        result = caught.exception.result
        self.assertEqual([step["number"] for step in result.report["failed_steps"]], [2])
        whole = [table for table in result.tables if table.parameters["load"] > 0.0]
        self.assertEqual([table.parameters["load"] for table in whole], [1e3, 4.7e3])
        for table, low in zip(whole, (result.measures["vlow"][0], result.measures["vlow"][2])):
            one = dalcs.run(STEPS.replace("list 1k 0 4.7k", f"list {table.parameters['load']}"))
            np.testing.assert_array_equal(table.values, one.values)
            self.assertEqual(low, one.measures["vlow"][0])
        self.assertTrue(math.isnan(result.measures["vlow"][1]))

    def test_a_run_that_fails_has_its_rows(self):
        netlist = """A source that comes to drive a diode without anything else
V1 in 0 PULSE(-1 5 1m 1u 1u 1 2)
D1 in 0
.tran 10u 3m
.end
"""
        with self.assertRaises(dalcs.NoSolution) as caught:
            dalcs.run(netlist)
        result = caught.exception.result
        self.assertGreater(len(result), 50)
        self.assertLess(result.t[-1], 1.01e-3)
        np.testing.assert_allclose(result["v(in)"][result.t < 1e-3], -1.0)


class Values(unittest.TestCase):
    def test_half_wave(self):
        for ohm in 50.0, 1e3, 20e3:
            result = dalcs.run(NETLIST, rload=ohm)
            end = closes(ohm)
            exact = [output(ohm, t) for t in result.t[result.t < end]]
            np.testing.assert_allclose(result["v(out)"][:len(exact)], exact, atol=1e-8)
            np.testing.assert_allclose(result.events["time"][:2], [opens(ohm), end], atol=1e-11)
            self.assertEqual(result.events["on"][:2].tolist(), [False, True])
            self.assertEqual(result.events["element"].tolist(), ["d1"] * len(result.events))
            self.assertAlmostEqual(result.measures["vlow"], output(ohm, end), delta=1e-7)
            self.assertTrue(math.isnan(result.measures["none"]))

    def test_a_thousand_runs(self):
        loads = np.linspace(100.0, 10e3, 1000)
        results = [dalcs.run(NETLIST, rload=ohm) for ohm in loads]
        self.assertEqual(len(results), 1000)
        for ohm, result in zip(loads, results):
            self.assertAlmostEqual(result.events["time"][0], opens(ohm), delta=1e-11)

    def test_other_values(self):
        text = NETLIST.replace("D1 in out", "D1 in out ideal\n.model ideal D(vfwd=0)")
        for name in "real(vfwd)", "ideal", "ideal(", "x1.r1":
            self.assertRaises(dalcs.OptionError, dalcs.run, text, {name: 1.0})
        for values, drop in ({}, 0.0), ({"ideal(vfwd)": 0.5}, 0.5), ({"Ideal(VFWD)": 2}, 2.0):
            result = dalcs.run(text, values, R1=500.0)
            self.assertAlmostEqual(result["V(OUT)"].max(), 10.0 - drop, delta=1e-5)
            self.assertTrue(drop or abs(result.events["time"][0] - opens(500.0)) < 1e-11)

    def test_operating_point_and_sweep(self):
        result = dalcs.run("divider\nV1 in 0 1\nR1 in out 1\nR2 out 0 3\n.op\n.dc v1 0 4 1\n")
        self.assertEqual([table.analysis for table in result.tables], ["op", "dc"])
        self.assertEqual(result.tables[0]["v(out)"].tolist(), [0.75])
        np.testing.assert_allclose(result["v(out)"], 0.75 * np.arange(5.0))
        self.assertIs(result["v1"], result.t)

    def test_complex_rows(self):
        result = dalcs.run("low pass\nV1 in 0 AC 1\nR1 in out 1k\nC1 out 0 1u\n.ac dec 5 1 1meg\n")
        exact = 1.0 / (1.0 + 2j * np.pi * result.t * 1e-3)
        self.assertEqual((result.scale, result.values.dtype.kind), ("frequency", "c"))
        np.testing.assert_allclose(result["v(out)"], exact, rtol=1e-9)

    def test_steps(self):
        result = dalcs.run(NETLIST + ".step param rload list 500 1k 2k\n")
        self.assertEqual([table.parameters["rload"] for table in result.tables], [500, 1e3, 2e3])
        self.assertEqual(result.parameters, {"rload": 2e3})
        np.testing.assert_allclose(result.measures["vlow"],
                                   [output(ohm, closes(ohm)) for ohm in (500, 1e3, 2e3)], atol=1e-7)

    def test_options(self):
        at = [0.0, 1e-3, 4e-3]
        result = dalcs.run(NETLIST, at=at, tol=1e-10, method="radau", stages=5, audit="full")
        self.assertEqual(result.t.tolist(), at)
        np.testing.assert_allclose(result["v(out)"], [output(1e3, t) for t in at], atol=1e-8)
        self.assertEqual((result.report["tolerance"], result.report["audit"]["mode"]), (1e-10, "full"))
        whole = dalcs.run(NETLIST)
        bare = dalcs.run(NETLIST, rows=False, fill=1e-3, compress=1e-3)
        self.assertEqual((len(bare), bare.measures["vlow"]), (0, whole.measures["vlow"]))
        self.assertEqual(bare.events.tolist(), whole.events.tolist())
        self.assertTrue(dalcs.run(NETLIST, energy=True).report["energy"]["resistors"] > 0.0)
        for name, value in ("tol", "much"), ("audit", "maybe"), ("stages", 2.5), ("curve", "splines"):
            with self.assertRaisesRegex(dalcs.OptionError, name):
                dalcs.run(NETLIST, **{name: value})

    def test_envelope(self):
        boost = dalcs.Circuit(BOOST).envelope(stop=0.1)
        self.assertEqual((boost.analysis, boost.report["envelope"]["periods"]), ("tran", 10000))
        self.assertLess(len(boost), 5000)
        self.assertEqual(dalcs.Circuit(BOOST).envelope(stop=0.1, r1=50).report["envelope"]["periods"], 10000)

    def test_losses_jumps_steady_check(self):
        losses = dalcs.run(NETLIST, losses=(20e-3, 40e-3)).losses
        self.assertEqual((losses["from"], losses["to"]), (0.02, 0.04))
        self.assertIsNone(dalcs.run(NETLIST).losses)
        (jump,) = dalcs.run(SOURCE / "netlists" / "tanks" / "charge_sharing.cir").jumps
        self.assertAlmostEqual(jump["states"]["c1"]["after"], 4.0, delta=1e-12)
        steady = dalcs.steady(SOURCE / "netlists" / "converters" / "buck.cir")
        self.assertEqual((steady.analysis, steady.steady["stable"]), ("pss", True))
        self.assertEqual(dalcs.check(NETLIST)["parts"][0]["verdicts"]["unique"]["answer"], "yes")

    def test_names(self):
        circuit = dalcs.Circuit(NETLIST)
        self.assertEqual(circuit.parameters, {"rload": 1e3})
        self.assertEqual(circuit.elements, ["v1", "d1", "c1", "r1"])

    def test_equations(self):
        (system,) = dalcs.equations(NETLIST)
        self.assertEqual((system.states, system.pairs), (("c1",), ("d1",)))
        matrix = {name: value.toarray() if hasattr(value, "toarray") else value
                  for name, value in system.matrices.items()}
        self.assertEqual(matrix["P"].tolist(), [[20e-6]])
        self.assertEqual(matrix["A_I"].shape, (1, 1))
        # v(c1) decays with 1/RC where the diode carries nothing: z from the second row, put into the first
        rate = matrix["A_I"] - matrix["B_I"] @ np.linalg.solve(matrix["B_II"], matrix["A_II"])
        self.assertAlmostEqual((rate / matrix["P"])[0, 0], -1.0 / (1e3 * 20e-6), delta=1e-9)
        (reduced,) = dalcs.equations(NETLIST, form="lcs")
        self.assertEqual(reduced.unknowns, ())
        self.assertRaises(ValueError, dalcs.equations, NETLIST, form="text")
        (other,) = dalcs.equations(NETLIST, {"C1": 3e-6})
        self.assertEqual(other["P"][0, 0], 3e-6)


class Rows(unittest.TestCase):
    def test_arrays_outlive_the_result(self):
        v = dalcs.run(NETLIST)["v(out)"]
        before = v.copy()
        gc.collect()
        for _ in range(20):
            dalcs.run(NETLIST)
        self.assertEqual(v.tobytes(), before.tobytes())

    def test_names_are_looked_up(self):
        result = dalcs.run(NETLIST)
        self.assertEqual(tuple(result), result.keys())
        self.assertTrue("V(OUT)" in result and "v(nowhere)" not in result)
        self.assertEqual(result.units["i(d1)"], "A")
        with self.assertRaisesRegex(KeyError, r"v\(out\)"):
            result["v(ou)"]  # pylint: disable=pointless-statement
        self.assertEqual(result.measures["VLOW"], result.measures["vlow"])
        system, = dalcs.equations(NETLIST)
        for there, name, told in ((result, "v(elsewhere)", r"no signal 'v\(elsewhere\)' among v\(in\), v\(out\)"),
                                  (result.measures, "vlw", "no measurement 'vlw'; did you mean 'vlow'"),
                                  (result.measures, "q", "no measurement 'q' among .*vlow"),
                                  (dalcs.run(NETLIST.replace(".meas", "*")).measures, "q", "'q' at all"),
                                  (system, "A_1", "no matrix 'A_1'; did you mean 'A_I'")):
            with self.assertRaisesRegex(KeyError, told):
                there[name]  # pylint: disable=pointless-statement

    @unittest.skipUnless(has("pandas"), "no pandas")
    def test_pandas(self):
        result = dalcs.run(NETLIST)
        frame = result.to_pandas()
        self.assertEqual(frame["v(out)"].to_numpy().tobytes(), result["v(out)"].tobytes())
        self.assertEqual(frame.index.name, "time")

    @unittest.skipUnless(has("matplotlib"), "no matplotlib")
    def test_plot(self):
        axes = dalcs.run(NETLIST).plot("v(in)", "v(out)")
        self.assertEqual([line.get_label() for line in axes.get_lines()], ["v(in)", "v(out)"])
        self.assertEqual(axes.get_ylabel(), "V")

    @unittest.skipUnless(has("matplotlib"), "no matplotlib")
    def test_jupyter(self):
        """What a notebook shows: signals with their ranges, of many runs the first."""
        shown = dalcs.run(NETLIST)._repr_html_()  # pylint: disable=protected-access
        self.assertIn("<tr><td>v(out)</td><td>V</td><td>0</td><td>10</td>", shown)
        self.assertIn("<p>no rows: 0</p>", dalcs.run(NETLIST, rows=False)._repr_html_())  # pylint: disable=protected-access
        text = NETLIST.replace("Half-wave rectifier", "t").replace("{rload}", "{1k+rload}")
        shown = dalcs.sweep(text, rload=[*range(30), -1000.0])._repr_html_()  # pylint: disable=protected-access
        self.assertEqual(shown.count("<tr>"), 21)
        self.assertIn("&lt;sweep of 31 runs, 1 failed", shown)

    def test_overlay(self):
        """Each step is a curve, of a colour that follows its parameter; a bar has the values."""
        result = dalcs.run(NETLIST + ".step param rload list 1k 3k 2k\n")
        axes = result.overlay("v(out)")
        lines = axes.get_lines()
        self.assertEqual([line.get_ydata().tobytes() for line in lines],
                         [table["v(out)"].tobytes() for table in result.tables])
        green = [line.get_color()[1] for line in lines]
        self.assertTrue(green[0] < green[2] < green[1], green)
        bar = axes.figure.axes[1]
        self.assertEqual((axes.get_ylabel(), bar.get_ylabel()), ("v(out) (V)", "rload"))
        np.testing.assert_allclose(bar.get_ylim(), (1e3, 3e3))
        with self.assertRaisesRegex(KeyError, "no parameter 'c1' among rload"):
            result.overlay("v(out)", by="c1")
        with self.assertRaises(KeyError):
            dalcs.run(NETLIST).overlay("v(out)")


class Errors(unittest.TestCase):
    def failure(self, kind, *arguments, **more):
        with self.assertRaises(kind) as caught:
            dalcs.run(*arguments, **more)
        return caught.exception

    def test_a_mistake_in_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mistake.cir"
            path.write_text(NETLIST.replace("20u\nR1", "abc\nR1"))
            error = self.failure(dalcs.NetlistError, path)
        self.assertEqual((error.file, error.line, error.element), (str(path), 5, "c1"))
        self.assertEqual(error.message, "expected a capacitance, not 'abc'")
        self.assertIn("C1 out 0 abc", str(error))

    def test_a_mistake_in_an_included_file(self):
        with tempfile.TemporaryDirectory() as folder:
            part, path = pathlib.Path(folder) / "part.inc", pathlib.Path(folder) / "whole.cir"
            part.write_text("R1 in out ohm\n")
            path.write_text("V\nV1 in 0 1\n.include part.inc\nR2 out 0 1\n.op\n")
            error = self.failure(dalcs.NetlistError, path)
        self.assertEqual((error.file, error.line, error.element), (str(part), 1, "r1"))

    def test_several_mistakes(self):
        error = self.failure(dalcs.NetlistError, "V\nV1 in 0 x\nR1 in 0 y\n.op\n")
        self.assertEqual((len(error.messages), error.line, error.element), (2, 2, "v1"))

    def test_no_solution(self):
        error = self.failure(dalcs.NoSolution, SOURCE / "netlists" / "hard" / "hc11b.cir")
        self.assertEqual((error.line, error.element, error.elements), (3, "v1", ("v1", "d1")))
        self.assertIn("drives d1 forward", error.message)

    def test_no_solution_later(self):
        error = self.failure(dalcs.NoSolution, NETLIST, rload=0)
        self.assertEqual((error.file, error.line, error.element), ("netlist", 3, "v1"))

    def test_names_and_values(self):
        error = self.failure(dalcs.OptionError, NETLIST, rlaod=3)
        self.assertIn("did you mean 'rload'?", str(error))
        self.assertIsInstance(error, ValueError)
        self.assertIn("nan", self.failure(dalcs.OptionError, NETLIST, rload=math.nan).message)
        error = self.failure(dalcs.NetlistError, NETLIST, c1=-1)
        self.assertEqual((error.element, error.line), ("c1", 5))

    def test_elements_are_those_that_have_values(self):
        text = "t\nV1 a 0 1\nL1 a net-(d1-pad1) 1m Rser=1\nR1 net-(d1-pad1) 0 {2}\n.op\n"
        elements = dalcs.Circuit(text, dialect="ltspice").elements
        self.assertEqual(sorted(elements), ["l1", "r1", "v1"])
        for element in elements:
            dalcs.run(text, {element: 2.0}, dialect="ltspice")

    def test_a_list_for_a_value(self):
        with self.assertRaisesRegex(TypeError, r"rload=\[1, 2\]: a run takes one value; sweep\(\) takes lists"):
            dalcs.run(NETLIST, rload=[1, 2])
        with self.assertRaisesRegex(TypeError, "rload=None is no number"):
            dalcs.run(NETLIST, rload=None)

    def test_values_as_in_netlists(self):
        text, number = dalcs.run(NETLIST, rload="2k"), dalcs.run(NETLIST, rload=2000.0)
        self.assertEqual(text.values.tobytes(), number.values.tobytes())
        with self.assertRaisesRegex(ValueError, "'2kk2' is no number of a netlist"):
            dalcs.run(NETLIST, rload="2kk2")

    def test_an_option_by_another_name(self):
        for name, choices in dalcs._session.CHOICES.items():  # pylint: disable=protected-access
            self.assertIn(f"its values are {', '.join(choices)}", str(self.failure(dalcs.OptionError, NETLIST, **{name: "zz"})))
            for choice in choices:
                dalcs._session.Options({name: choice})  # pylint: disable=protected-access
        self.assertIn("did you mean the option 'tol'?", str(self.failure(dalcs.OptionError, NETLIST, tolerance=1e-9)))
        self.assertNotIn("option", str(self.failure(dalcs.OptionError, NETLIST, zz9=1e-9)))

    def test_help_names_the_options(self):
        for function in dalcs.run, dalcs.sweep, dalcs.steady:
            self.assertIn(getattr(dalcs.Circuit, function.__name__).__doc__.split("\n")[0], function.__doc__)
        self.assertIn("tol, method, stages", dalcs.run.__doc__)

    def test_a_result_is_not_copied(self):
        result = dalcs.run(NETLIST)
        for copied in pickle.dumps, copy.deepcopy:
            with self.assertRaisesRegex(TypeError, "send its arrays"):
                copied(result)

    def test_a_file_that_is_not_there(self):
        self.assertIn("cannot read", self.failure(dalcs.Error, "nowhere.cir").message)

    def test_they_can_be_sent(self):
        error = self.failure(dalcs.NetlistError, NETLIST, c1=-1)
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((type(again), str(again), again.line), (type(error), str(error), error.line))


class Ended(unittest.TestCase):
    """Early: each ends long before the 1000 s of its .tran, at the first call of progress."""

    def run_long(self, progress):
        text = ENDLESS.read_text().rstrip()
        self.assertIn(".tran", text)
        cards = [card for card in text.splitlines()
                 if not card.lower().startswith((".tran", ".meas", ".end"))]
        dalcs.run("\n".join([*cards, ".tran 1 1000", ""]), rows=False, progress=progress)

    def test_by_ctrl_c(self):
        usual = signal.getsignal(signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            self.run_long(lambda time, stop: os.kill(os.getpid(), signal.SIGINT))
        self.assertIs(signal.getsignal(signal.SIGINT), usual)

    def test_by_an_exception(self):
        def give_up(time, stop):
            raise LookupError(f"{time} of {stop}")

        with self.assertRaisesRegex(LookupError, "of 1000"):
            self.run_long(give_up)

    def test_in_a_thread(self):
        found = []

        def work():
            try:
                self.run_long(lambda time, stop: 1 / 0)
            except ZeroDivisionError as error:
                found.append(error)

        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        self.assertEqual(len(found), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
