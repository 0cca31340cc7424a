"""Circuits of a table, ideal and with resistances, whose end is that of a finer run and which take no Euler step."""

from dalcs_program import Checker, run, some_of


def compare_ends(program, name, cases, ohms, netlist, signal, finer, allowed):
    """The exit status. cases: tuples that begin with a kind; ohms: {name: what netlist(case, ohms) takes, which is
    None where a case has no such circuit}; finer: the
    arguments of run() for the run that is taken for exact; allowed: over the signal's value at the end."""
    checker = Checker(name)
    for k, case in enumerate(some_of(cases, 1)):
        for kind, of_kind in ohms.items():
            what = f"{case[0]} {k}, {kind}"
            text = netlist(case, of_kind)
            if text is None:
                continue
            outcome = run(program, text, method=None, options=["--audit", "full"])
            exact = run(program, text, method=None, **finer)
            if checker.check(outcome.status == exact.status == 0, f"{what}: {outcome.stderr[:300]} {exact.stderr[:300]}"):
                n_euler = outcome.report["work"]["euler_steps"]
                checker.check(n_euler == 0, f"{what}: {n_euler} steps of implicit Euler")
                wanted = exact.column(signal)[-1]
                checker.close(outcome.column(signal)[-1], wanted, allowed * abs(wanted), f"{what}: {signal}")
    return checker.finish()
