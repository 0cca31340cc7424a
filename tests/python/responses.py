#!/usr/bin/env python3
"""Frequency responses, sensitivities and slow starts from Python, against closed forms.

usage: responses.py SOURCE_FOLDER, with PYTHONPATH=build/src/python
"""

import os
import pathlib
import signal
import sys
import tempfile
import unittest

import numpy as np

import dalcs

SOURCE = pathlib.Path(sys.argv[1])
VIN, L, C, R = 12.0, 50e-6, 20e-6, 2.0
# the clock at 100 kHz, natural sampling: no delay
BUCK = f"""The duty cycle of a buck converter to its output
.param load={R}
Vin in 0 {VIN}
Vctl ctl 0 DC 0.4 AC 1
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out {L}
C1 out 0 {C}
R1 out 0 {{load}}
.model sm SW(Ron=0 Vt=0)
"""
LOOP = f"""A buck converter that an amplifier closes: the same converter is in the loop
Vin in 0 {VIN}
Vref ref 0 0.45
Vloop out fb 0
E2 ctl 0 ref fb2 8
E3 fb2 0 fb 0 0.1
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out {L}
C1 out 0 {C}
R1 out 0 {R}
.model sm SW(Ron=0 Vt=0)
.pss uic
"""
BOOST = """A boost converter in discontinuous conduction
.param ton=3u
Vin in 0 5
L1 in sw 5u
Vg g 0 PULSE(0 1 0 0 0 {ton} 10u)
S1 sw 0 g 0 sm
D1 sw out
C1 out 0 100u
R1 out 0 50
.model sm SW(Ron=0 Vt=0.5)
.meas pss vout avg v(out)
.meas pss peak max i(l1)
"""


def gain(frequency, load=R):
    s = 2j * np.pi * np.asarray(frequency)
    return VIN / (1.0 + s * L / load + s * s * L * C)


class Responses(unittest.TestCase):
    def test_given_frequencies(self):
        asked = np.geomspace(10.0, 90e3, 37)
        found = dalcs.bode(BUCK, frequencies=asked)
        self.assertIsInstance(found, dalcs.Response)
        self.assertEqual(found.frequency.tobytes(), asked.tobytes())
        np.testing.assert_allclose(found["v(out)"], gain(asked), rtol=1e-7)
        np.testing.assert_allclose(found.decibels("v(out)"), 20.0 * np.log10(abs(gain(asked))), atol=1e-6)
        np.testing.assert_allclose(found.phase("v(out)"), np.degrees(np.unwrap(np.angle(gain(asked)))), atol=1e-5)
        self.assertEqual((found.analysis, found.scale, found.loop), ("ac", "frequency", None))
        self.assertEqual(len(found.phase_margins), 0)

    def test_a_range(self):
        found = dalcs.bode(BUCK, start=10.0, stop=1e4, points=5)
        np.testing.assert_allclose(found.frequency, np.geomspace(10.0, 1e4, 16))
        usual = dalcs.bode(BUCK)
        self.assertEqual((usual.frequency[0], round(usual.frequency[-1]), len(usual)), (10.0, 44668, 74))

    def test_other_values(self):
        for given in {"load": 5.0}, {"R1": 5.0}:
            found = dalcs.bode(BUCK, given, frequencies=[3e3])
            np.testing.assert_allclose(found["v(out)"], gain([3e3], 5.0), rtol=1e-7)
        np.testing.assert_allclose(dalcs.bode(BUCK, load="5", frequencies=[3e3])["v(out)"], gain([3e3], 5.0), rtol=1e-7)

    def test_a_loop(self):
        """0.8 V of control for each volt of the output: magnitude and phase of its gain at the crossover."""
        found = dalcs.bode(LOOP, loop="vloop", frequencies=np.geomspace(100.0, 45e3, 60))
        self.assertTrue(found.steady["stable"])
        (margin,) = found.phase_margins
        low, high = 100.0, 45e3
        for _ in range(80):
            middle = np.sqrt(low * high)
            low, high = (middle, high) if abs(0.8 * gain(middle)) > 1.0 else (low, middle)
        # the ripple at the comparator adds to the ramp: the averaged model is near, not right
        self.assertAlmostEqual(margin["frequency"] / low, 1.0, delta=0.2)
        at = np.interp(margin["frequency"], found.frequency, found.decibels("loop(vloop)"))
        self.assertAlmostEqual(at, 0.0, delta=0.1)
        phase = np.interp(margin["frequency"], found.frequency, found.phase("loop(vloop)"))
        self.assertAlmostEqual((phase + 180.0 - margin["margin"] + 180.0) % 360.0 - 180.0, 0.0, delta=0.5)
        self.assertEqual(found.loop.tobytes(), found["loop(vloop)"].tobytes())
        both = dalcs.bode(LOOP, loop="vloop", injection="both", frequencies=[1e3, 1e4])
        self.assertEqual(both.report["response"]["injection"], "both")

    def test_several_in_threads(self):
        loads = [1.0, 2.0, 4.0]
        table = dalcs.sweep(BUCK, {"load": loads}, bode=True, frequencies=[5e3], workers=2,
                            each=lambda r: abs(r["v(out)"][0]))
        np.testing.assert_allclose(table["value"], [abs(gain(5e3, load)) for load in loads], rtol=1e-7)

    def test_frames_and_pictures(self):
        found = dalcs.bode(LOOP, loop="vloop", frequencies=[1e3, 1e4, 4e4])
        above, below = found.plot()
        self.assertEqual([len(axes.get_lines()) for axes in (above, below)], [1, 1])
        np.testing.assert_allclose(above.get_lines()[0].get_ydata(), found.decibels("loop(vloop)"))
        self.assertEqual((above.get_xscale(), above.get_ylabel(), below.get_ylabel()), ("log", "dB", "deg"))
        again = found.plot("v(out)", "v(ctl)", ax=(above, below))
        self.assertIs(again[0], above)
        self.assertEqual(len(above.get_lines()), 3)
        try:
            import pandas  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            return
        frame = found.to_pandas()
        self.assertEqual((frame.index.name, frame.shape[0]), ("frequency", 3))
        self.assertEqual(frame["loop(vloop)"].iloc[1], found.loop[1])

    def test_plain_ac(self):
        """Around an operating point, as .ac has it: the same pictures, and real rows have none."""
        found = dalcs.run("RC\nV1 in 0 AC 1\nR1 in out 1k\nC1 out 0 1u\n.ac dec 10 1 1e6\n")
        exact = 1.0 / (1.0 + 2j * np.pi * found.t * 1e-3)
        np.testing.assert_allclose(found.phase("v(out)"), np.degrees(np.angle(exact)), atol=1e-9)
        self.assertEqual(len(found.plot_bode("v(out)")), 2)
        with self.assertRaisesRegex(ValueError, "plot.. draws them"):
            dalcs.run("R\nV1 in 0 1\nR1 in 0 1\n.op\n").plot_bode()

    def test_mistakes(self):
        def failure(kind, text=BUCK, **more):
            with self.assertRaises(kind) as caught:
                dalcs.bode(text, **more)
            return caught.exception

        self.assertIn("no voltage source 'vx'", failure(dalcs.Error, loop="vx").message)
        error = failure(dalcs.OptionError, frequencies=[1e3, 1e3])
        self.assertIn("frequency 2 is 1000 Hz", error.message)
        self.assertIn("above the last", str(error))
        for bad in [0.0, 1.0], [-1.0], [float("nan")], [float("inf")]:
            self.assertIn("Hz", failure(dalcs.OptionError, frequencies=bad).message)
        failure(ValueError, frequencies=[])
        failure(ValueError, frequencies=[[1.0, 2.0]])
        failure(TypeError, frequencies=[1e3], start=10.0)
        self.assertIn("bode_injection", failure(dalcs.OptionError, loop="vin", injection="current").message)
        self.assertIn("no frequencies", failure(dalcs.OptionError, start=1e3, stop=10.0).message)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "mistake.cir"
            path.write_text(BUCK.replace("20u", "abc").replace(f"C1 out 0 {C}", "C1 out 0 abc"))
            for call in dalcs.bode, dalcs.steady, dalcs.envelope:
                with self.assertRaises(dalcs.NetlistError) as caught:
                    call(path)
                error = caught.exception
                self.assertEqual((error.file, error.line, error.element), (str(path), 10, "c1"))
        rests = failure(dalcs.NoSolution, "RC\nV1 in 0 AC 1\nR1 in out 1k\nC1 out 0 1u\n")
        self.assertIn("a run with .ac dec 20 1 1meg has the response", str(rests))
        silent = failure(dalcs.Error, BUCK.replace(" AC 1", ""), frequencies=[1e3])
        self.assertIn("no source has an AC value", silent.message)

    def test_ctrl_c(self):
        usual = signal.getsignal(signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            dalcs.bode(BUCK, frequencies=np.geomspace(1.0, 4e4, 200000),
                       progress=lambda at, stop: os.kill(os.getpid(), signal.SIGINT))
        self.assertIs(signal.getsignal(signal.SIGINT), usual)


class Sensitivities(unittest.TestCase):
    def test_closed_form(self):
        """vout = vin (1 + sqrt(1 + 2 ton^2 R/(L T)))/2 up to the ripple; the peak of the current exactly."""
        found = dalcs.steady(BOOST, sensitivities=True).sensitivities
        self.assertEqual(found.parameters, {"vin": 5.0, "l1": 5e-6, "c1": 100e-6, "r1": 50.0})
        for result in "vout", "peak", "average v(out)", "rms i(l1)":
            self.assertIn(result, found)
        root = np.sqrt(1.0 + 2.0 * 9e-12 * 50.0 / (5e-6 * 1e-5))
        by_r = 5.0 / 2.0 * (2.0 * 9e-12 / (5e-6 * 1e-5)) / (2.0 * root)
        self.assertAlmostEqual(found["vout"]["r1"] / by_r, 1.0, delta=2e-3)
        self.assertAlmostEqual(found["peak"]["vin"], 3e-6 / 5e-6, delta=1e-9)
        row = found.results.index("peak")
        np.testing.assert_allclose(found.relative[row], [1.0, -1.0, 0.0, 0.0], atol=1e-7)
        self.assertEqual(found.derivatives.shape, (len(found), 4))
        with self.assertRaisesRegex(KeyError, "no result 'vuot'; did you mean 'vout'"):
            found["vuot"]

    def test_chosen_ones(self):
        found = dalcs.run(BOOST + ".pss uic\n.sens param ton\n").sensitivities
        self.assertEqual(list(found.parameters), ["ton"])
        self.assertAlmostEqual(found["peak"]["ton"], 5.0 / 5e-6, delta=1.0)
        self.assertIsNone(dalcs.steady(BOOST).sensitivities)

    def test_frame(self):
        try:
            import pandas  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            self.skipTest("no pandas")
        found = dalcs.steady(BOOST, sensitivities=True).sensitivities
        frame = found.to_pandas(relative=True)
        self.assertAlmostEqual(frame.loc["peak", "l1"], -1.0, delta=1e-7)
        self.assertEqual(found.to_pandas().loc["peak", "vin"], found["peak"]["vin"])


class WorstCases(unittest.TestCase):
    def test_threads(self):
        text = ("t\nV1 in 0 10\nR1 in out 1k DEV=5%\nR2 out 0 1k DEV=5%\nC1 out 0 1u DEV=10%\n.tran 10u 1m\n"
                ".meas tran v find v(out) at=1m\n.wcase\n")
        one, three = (dalcs.run(text, workers=n, rows=False).report["worst_case"] for n in (1, 3))
        self.assertEqual(one, three)
        self.assertAlmostEqual(one["results"][0]["largest"], 10 * 1.05 / (1.05 + 0.95), delta=1e-9)
        with self.assertRaisesRegex(ValueError, "a .wcase is a part of one run"):
            dalcs.variants(text)


class Envelopes(unittest.TestCase):
    def test_function(self):
        text = BOOST.replace("C1 out 0 100u", "C1 out 0 10m")
        found = dalcs.envelope(text, stop=0.05, r1=100)
        self.assertEqual(found.report["envelope"]["periods"], 5000)
        again = dalcs.Circuit(text).envelope(stop=0.05, r1="100")
        self.assertEqual(found.values.tobytes(), again.values.tobytes())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
