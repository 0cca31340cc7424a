#!/usr/bin/env python3
"""Sweeps from Python: the same bytes whatever the number of threads, failures in the table, Ctrl-C.

usage: sweeps.py SOURCE_FOLDER, with PYTHONPATH=build/src/python
"""

import os
import pathlib
import pickle
import re
import signal
import sys
import threading
import unittest

import numpy as np

import dalcs
from half_wave import NETLIST, closes, opens, output

SOURCE = pathlib.Path(sys.argv[1])
LOADS = np.geomspace(50.0, 20e3, 60)


def children():
    """Processes that this one has started and that are still there."""
    return [int(pid) for pid in pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()]


def bytes_of(sweep):
    return {name: pickle.dumps(column.tolist()) for name, column in sweep.columns.items()}


class Sweeps(unittest.TestCase):
    def test_a_table_of_nothing_says_so(self):
        bare = re.sub(r"(?im)^\.meas.*\n", "", NETLIST)
        self.assertIn("nothing was kept: write .meas", repr(dalcs.sweep(bare, {"rload": LOADS[:2]})))
        for sweep in (dalcs.sweep(bare, {"rload": LOADS[:2]}, each=len), dalcs.sweep(bare, {"rload": [0.0]}),
                      dalcs.sweep(NETLIST, {"rload": LOADS[:2]})):
            self.assertNotIn("nothing", repr(sweep))

    def test_closed_form(self):
        sweep = dalcs.sweep(NETLIST, {"rload": LOADS}, workers=2)
        self.assertEqual(sweep["rload"].tobytes(), LOADS.tobytes())
        np.testing.assert_allclose(sweep["vlow"], [output(ohm, closes(ohm)) for ohm in LOADS], atol=1e-7)
        self.assertEqual((set(sweep["error"]), sweep.errors), ({""}, {}))
        self.assertIs(sweep["VLow"], sweep["vlow"])
        with self.assertRaisesRegex(KeyError, "no column 'vlov'; did you mean 'vlow'"):
            sweep["vlov"]  # pylint: disable=pointless-statement

    def test_a_mistake_of_the_call_is_none_of_a_variant(self):
        with self.assertRaisesRegex(dalcs.OptionError, "did you mean 'rload'"):
            dalcs.sweep(NETLIST, rlaod=LOADS[:2])
        with self.assertRaisesRegex(dalcs.OptionError, "no value of the option method"):
            dalcs.sweep(NETLIST, rload=LOADS[:2], method="rk4")

    def test_workers_change_no_byte(self):
        grid = {"rload": LOADS[::6], "c1": [5e-6, 20e-6, 80e-6]}

        def each(result):
            return {"rows": result.values.tobytes(), "events": result.events.tobytes(), **result.measures}

        one, two, five = (dalcs.sweep(NETLIST, grid, workers=n, each=each, isolate=n == 5) for n in (1, 2, 5))
        self.assertEqual(len(one), 30)
        self.assertEqual(bytes_of(one), bytes_of(two))
        self.assertEqual(bytes_of(one), bytes_of(five))
        alone = dalcs.run(NETLIST, one.points[17])
        self.assertEqual(one["rows"][17], alone.values.tobytes())

    def test_workers_change_no_byte_of_converters(self):
        for name in "buck", "flyback_rcd", "buck_closed_loop":
            path = SOURCE / "netlists" / "converters" / f"{name}.cir"
            element = next(e for e in dalcs.Circuit(path).elements if e.startswith("r"))
            grid = {element: [1.0, 2.0, 5.0, 11.0]}
            one, two = (dalcs.sweep(path, grid, workers=n, each=lambda r: r.values.tobytes())
                        for n in (1, 2))
            self.assertEqual(bytes_of(one), bytes_of(two), name)

    def test_variants_are_the_netlists_own_runs(self):
        text = NETLIST + ".param tol={mc(1, 0.2)}\nR9 out 0 {tol*1Meg}\n.mc 30\n"
        whole = dalcs.run(text, rows=False).measures["vlow"]
        one, two = (dalcs.variants(text, workers=n) for n in (1, 2))
        self.assertEqual(bytes_of(one), bytes_of(two))
        self.assertEqual(list(one)[:2], ["run", "tol"])
        self.assertEqual(one["vlow"].tobytes(), whole.tobytes())
        self.assertEqual(len(set(one["tol"])), 30)
        alone = dalcs.run(text, only=17)
        self.assertEqual((alone.drawn["tol"], alone.measures["vlow"]), (one["tol"][16], one["vlow"][16]))
        self.assertEqual(list(one.effects("vlow")), ["tol"])
        self.assertFalse(set(one["tol"]) & set(dalcs.variants(text, seed=2)["tol"]))
        with self.assertRaises(ValueError):
            dalcs.variants(NETLIST)
        with self.assertRaises(dalcs.OptionError):
            dalcs.run(text, seed=-1)
        failing = dalcs.variants(text.replace(".mc 30", "C9 out 0 {limit(0, 1u)}\n.mc 30"))
        self.assertTrue(0 < len(failing.errors) < 30)

    def test_order_of_points(self):
        sweep = dalcs.sweep(NETLIST, {"rload": [1e3, 2e3], "c1": [1e-6, 2e-6, 3e-6]}, workers=2)
        self.assertEqual(sweep["rload"].tolist(), [1e3] * 3 + [2e3] * 3)
        self.assertEqual(sweep["c1"].tolist(), [1e-6, 2e-6, 3e-6] * 2)
        self.assertEqual(len(dalcs.sweep(NETLIST, {"rload": []})), 0)

    def test_lists_by_name(self):
        grid = dalcs.sweep(NETLIST, {"rload": [1e3, 2e3], "c1": [5e-6, 20e-6]})
        named = dalcs.sweep(NETLIST, rload=["1k", 2e3], c1=[5e-6, "20u"])
        both = dalcs.sweep(NETLIST, {"rload": [1e3, 2e3]}, c1=[5e-6, 20e-6])
        self.assertEqual(bytes_of(grid), bytes_of(named))
        self.assertEqual(bytes_of(grid), bytes_of(both))
        with self.assertRaisesRegex(TypeError, r"sweep\(netlist, r1=\["):
            dalcs.sweep(NETLIST, rload=1e3)
        with self.assertRaisesRegex(TypeError, "c1 cannot stand beside it"):
            dalcs.sweep(NETLIST, [{"rload": 1e3}], c1=[5e-6])

    def test_one_value_each(self):
        sweep = dalcs.sweep(NETLIST, {"rload": LOADS[:5]}, each=lambda r: r.events["time"][0])
        np.testing.assert_allclose(sweep["value"], [opens(ohm) for ohm in LOADS[:5]], atol=1e-11)


    def test_effects(self):
        """Of a table whose plane is known, in which a third parameter does not vary and one run failed."""
        draw = np.random.default_rng(3)
        points = [{"a": a, "b": b, "c": 2.0} for a, b in zip(draw.uniform(1, 3, 40), draw.normal(0, 1e-6, 40))]
        kept = [{"y": 5 - 2 * p["a"] + 7e6 * p["b"]} for p in points]
        kept[4] = ValueError("no")
        table = dalcs.Sweep(points, kept)
        well = [k for k in range(40) if k != 4]
        effects = table.effects("y")
        self.assertEqual(list(effects), ["b", "a"])
        self.assertAlmostEqual(effects["a"], -2 * np.ptp(table["a"][well]), places=9)
        self.assertAlmostEqual(effects["b"], 7e6 * np.ptp(table["b"][well]), places=9)
        self.assertEqual([bar.get_width() for bar in table.tornado("y").patches], list(effects.values())[::-1])
        self.assertEqual(sum(bar.get_height() for bar in table.hist("y").patches), 39)
        with self.assertRaisesRegex(ValueError, "too few"):
            dalcs.Sweep(points[:2], kept[:2]).effects("y")

    def test_xarray(self):
        try:
            import xarray  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            self.skipTest("xarray is not there")
        grid = dalcs.sweep(NETLIST, {"rload": [1e3, 2e3], "c1": [1e-6, 2e-6, 3e-6]})
        data = grid.to_xarray()
        self.assertEqual(dict(data.sizes), {"rload": 2, "c1": 3})
        self.assertEqual(float(data["vlow"].sel(rload=2e3, c1=2e-6)), grid["vlow"][4])
        self.assertEqual(dict(dalcs.Sweep([{"a": 1.0}, {"a": 1.0}], [2.0, 3.0]).to_xarray().sizes), {"run": 2})
        rows = dalcs.run(NETLIST)
        self.assertEqual(rows.to_xarray()["v(out)"].values.tobytes(), rows["v(out)"].tobytes())


class Failures(unittest.TestCase):
    def test_a_bad_variant(self):
        for workers in 1, 2:
            points = [{"rload": ohm} for ohm in LOADS]
            points[7] = {"rload": 0.0}  # the source drives the diode around a loop
            points[23] = {"rload": 1e3, "c1": -1.0}
            points[41] = {"rlaod": 1e3}
            points[42] = {"rload": float("nan")}
            sweep = dalcs.sweep(NETLIST, points, workers=workers)
            self.assertEqual(sorted(sweep.errors), [7, 23, 41, 42])
            kinds = [type(sweep.errors[k]) for k in (7, 23, 41, 42)]
            self.assertEqual(kinds, [dalcs.NoSolution, dalcs.NetlistError, dalcs.OptionError,
                                     dalcs.OptionError])
            self.assertEqual((sweep.errors[23].element, sweep.errors[23].line), ("c1", 5))
            self.assertIn("no solution exists", sweep["error"][7])
            good = [k for k in range(60) if k not in sweep.errors]
            self.assertEqual(set(sweep["error"][good]), {""})
            self.assertTrue(np.isnan(sweep["vlow"][[7, 23, 41, 42]]).all())
            np.testing.assert_allclose(sweep["vlow"][good],
                                       [output(LOADS[k], closes(LOADS[k])) for k in good], atol=1e-7)

    def test_a_bad_reduction(self):
        sweep = dalcs.sweep(NETLIST, {"rload": [1e3, 2e3]}, each=lambda r: r["v(nowhere)"])
        self.assertEqual(sorted(sweep.errors), [0, 1])
        self.assertRegex(sweep["error"][1], "KeyError.*v.nowhere")

    def test_a_mistake_in_the_netlist(self):
        sweep = dalcs.sweep(NETLIST.replace("20u\nR1", "abc\nR1"), {"rload": [1.0, 2.0]})
        self.assertEqual(set(sweep["error"]), {"expected a capacitance, not 'abc'"})

    def test_ctrl_c(self):
        """While two threads run for 1000 s of simulated time each."""
        text = (SOURCE / "netlists" / "converters" / "buck_closed_loop.cir").read_text()
        cards = [card for card in text.splitlines()
                 if not card.lower().startswith((".tran", ".meas", ".end"))]
        for workers in 1, 2:
            pressed = []

            def press(time, stop, pressed=pressed):
                if not pressed:
                    pressed.append((time, stop))
                    os.kill(os.getpid(), signal.SIGINT)

            with self.assertRaises(KeyboardInterrupt):
                dalcs.sweep("\n".join([*cards, ".tran 1 1000", ""]), [{}, {}, {}], workers=workers,
                            progress=press)
            self.assertEqual(len(pressed), 1)
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_ctrl_c_loses_no_run(self):
        """That is over: the exception has the table, in which the others were not run."""
        for workers in 1, 2:
            def press(done, count):
                self.assertEqual(count, 60)
                if done >= 20:
                    os.kill(os.getpid(), signal.SIGINT)

            with self.assertRaises(KeyboardInterrupt) as caught:
                dalcs.sweep(NETLIST, {"rload": LOADS}, workers=workers, done=press)
            table = caught.exception.sweep
            well = [k for k in range(60) if k not in table.errors]
            self.assertGreaterEqual(len(well), 20)
            np.testing.assert_allclose(table["vlow"][well], [output(LOADS[k], closes(LOADS[k])) for k in well],
                                       atol=1e-7)
            if workers == 1:  # two may be done before the other thread is told
                self.assertEqual(well, list(range(len(well))))
                self.assertEqual(set(table["error"][len(well):]), {"not run: the sweep was ended before"})

    def test_a_crash(self):
        """Of the process in which a run is made, by faults, by the system and by exit(), loses that run alone."""
        ends = {7: signal.SIGSEGV, 23: signal.SIGKILL, 24: signal.SIGABRT, 41: 3}

        def each(result):
            k = next(k for k, ohm in enumerate(LOADS) if result.measures["rload"] == ohm)
            if ends.get(k) == 3:
                os._exit(3)
            if k in ends:
                os.kill(os.getpid(), ends[k])
            return result.measures

        text = NETLIST + ".meas tran rload param={rload}\n"
        for workers in 1, 2, 5:
            table = dalcs.sweep(text, {"rload": LOADS}, workers=workers, each=each, isolate=True)
            self.assertEqual(sorted(table.errors), sorted(ends))
            self.assertEqual({type(error) for error in table.errors.values()}, {dalcs.Crashed})
            self.assertIn("ended: Segmentation fault", table["error"][7])
            self.assertIn("Killed, which the system does where memory runs out", table["error"][23])
            self.assertIn("ended: status 3", table["error"][41])
            good = [k for k in range(60) if k not in ends]
            np.testing.assert_allclose(table["vlow"][good], [output(LOADS[k], closes(LOADS[k])) for k in good], atol=1e-7)
            self.assertEqual(children(), [])

    def test_a_process_that_is_killed(self):
        """Without a word of the caller: runs are made in other processes."""
        for workers in 1, 2:
            killed = []

            def kill(done, count, killed=killed):
                self.assertEqual(count, 60)
                if done >= 10 and not killed:
                    killed.extend(children()[:1])
                    os.kill(killed[0], signal.SIGKILL)

            table = dalcs.sweep(NETLIST.replace("10u 40m", "10u 4"), {"rload": LOADS}, workers=workers, done=kill)
            self.assertEqual(len(table.errors), 1)
            self.assertEqual({type(error) for error in table.errors.values()}, {dalcs.Crashed})
            self.assertEqual(children(), [])

    def test_what_cannot_be_sent(self):
        table = dalcs.sweep(NETLIST, {"rload": LOADS[:3]}, each=lambda result: result, isolate=True)
        self.assertIn("memory of libdalcs", table["error"][2])
        seen = []
        table = dalcs.sweep(NETLIST, {"rload": LOADS[:3]}, each=seen.append)  # in threads: the caller's memory
        self.assertEqual((len(seen), len(table.errors)), (3, 0))

        class Strange(Exception):
            """Local, so that no other process can make one."""

        def fail(result):
            raise Strange("why")

        table = dalcs.sweep(NETLIST, {"rload": LOADS[:3]}, each=fail, isolate=True)
        self.assertEqual(list(table["error"]), ["Strange: why"] * 3)

    def test_how_many_are_done(self):
        for workers in 1, 2:
            told = []
            dalcs.sweep(NETLIST, {"rload": LOADS[:12]}, workers=workers,
                        done=lambda done, count: told.append((done, count, threading.current_thread())))
            self.assertEqual(told[-1][:2], (12, 12))
            self.assertEqual([row[0] for row in told], sorted({row[0] for row in told}))
            self.assertEqual({row[2] for row in told}, {threading.main_thread()})
        counted = []
        dalcs.variants(NETLIST + ".mc 5\n", done=lambda done, count: counted.append(done))
        self.assertEqual(counted[-1], 5)

    def test_an_exception_of_done(self):
        for workers in 1, 2:
            with self.assertRaises(ZeroDivisionError) as caught:
                dalcs.sweep(NETLIST, {"rload": LOADS}, workers=workers, done=lambda done, count: 1 / 0)
            self.assertEqual(len(caught.exception.sweep), 60)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
