#!/usr/bin/env python3
"""Runs in processes of joblib and in workers of Dask: the same values, exceptions as they were, a killed worker.

usage: workers.py SOURCE_ROOT BUILD_ROOT

What is not installed is skipped.
"""

import importlib.util
import os
import signal
import tempfile
import time
import unittest

import dalcs

NETLIST = """a rectifier with a load
.param load=1k
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 10u
R1 out 0 {load}
.tran 10u 60m uic
.meas tran vlow min v(out) from=40m
.end
"""
LOADS = [500.0 + 50.0 * k for k in range(24)]


def run_one(load):
    return dalcs.run(NETLIST, load=load, rows=False).measures["vlow"]


def run_slowly(load, folder):
    """Leaves a file with its process behind, and takes long enough to be killed."""
    with open(os.path.join(folder, str(load)), "w", encoding="ascii") as mark:
        mark.write(str(os.getpid()))
    time.sleep(0.05)
    return run_one(load)


@unittest.skipUnless(importlib.util.find_spec("joblib"), "joblib is not installed")
class Joblib(unittest.TestCase):
    def test_processes_and_threads(self):
        import joblib  # pylint: disable=import-outside-toplevel
        here = [run_one(load) for load in LOADS]
        for backend in "loky", "threading":
            there = joblib.Parallel(n_jobs=2, backend=backend)(joblib.delayed(run_one)(load) for load in LOADS)
            self.assertEqual(there, here)
        with self.assertRaises(dalcs.NoSolution) as caught:
            joblib.Parallel(n_jobs=2)(joblib.delayed(run_one)(load) for load in (500.0, 0.0))
        self.assertEqual((caught.exception.element, caught.exception.line), ("v1", 3))

    def test_memory(self):
        import joblib  # pylint: disable=import-outside-toplevel
        with tempfile.TemporaryDirectory() as folder:
            kept = joblib.Memory(folder, verbose=0).cache(run_one)
            self.assertEqual(kept(500.0), run_one(500.0))
            self.assertTrue(kept.check_call_in_cache(500.0))


@unittest.skipUnless(importlib.util.find_spec("distributed"), "Dask is not installed")
class Dask(unittest.TestCase):
    def test_two_workers(self):
        from distributed import Client, LocalCluster  # pylint: disable=import-outside-toplevel
        here = [run_one(load) for load in LOADS]
        with tempfile.TemporaryDirectory() as folder, \
                LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster, \
                Client(cluster) as client:
            self.assertEqual(client.gather(client.map(run_one, LOADS)), here)
            failed = client.submit(run_one, 0.0).exception()
            self.assertIsInstance(failed, dalcs.NoSolution)
            self.assertEqual((failed.element, failed.line), ("v1", 3))
            table = client.submit(dalcs.sweep, NETLIST, {"load": LOADS[:3]}).result()
            self.assertEqual(list(table["vlow"]), here[:3])
            slow = client.map(run_slowly, LOADS, folder=folder, pure=False)
            while not os.listdir(folder):
                time.sleep(0.01)
            os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
            self.assertEqual(client.gather(slow), here)


if __name__ == "__main__":
    unittest.main(argv=["workers.py"])
