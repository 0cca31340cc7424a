"""The response to small signals around a periodic steady state."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional

import numpy as np
from numpy.typing import NDArray

from ._result import Result


def _margins(found: List[Mapping[str, float]], key: str) -> NDArray[Any]:
    rows = [(entry["frequency"], entry[key]) for entry in found]
    return np.array(rows, dtype=[("frequency", "f8"), ("margin", "f8")])


class Response(Result):
    """What small sines on the sources with AC make of each signal: n frequencies, m signals.

    frequency    [n] Hz; t is the same
    values       [n, m] complex; result["v(out)"] is one column
    loop         [n] complex, the gain of the loop that was asked for; None without one
    decibels(name), phase(name)   [n] dB, [n] degrees

    >>> import dalcs
    >>> response = dalcs.bode('''An RC behind a chopper that does nothing to its small signal
    ... Vin in 0 PULSE(0 1 0 0 0 5u 10u) AC 1
    ... R1 in out 1k
    ... C1 out 0 159.15494n
    ... ''', frequencies=[100.0, 1e3, 1e4])
    >>> response.decibels("v(out)").round(2).tolist(), response.phase("v(out)").round(1).tolist()
    ([-0.04, -3.01, -20.04], [-5.7, -45.0, -84.3])
    """

    @property
    def frequency(self) -> NDArray[Any]:
        """[n] Hz"""
        return self.t

    @property
    def _told(self) -> Dict[str, Any]:
        return dict(self.report.get("response", {}))

    @property
    def loop(self) -> Optional[NDArray[Any]]:
        """[n] the gain of the loop, complex; None where no loop was asked for."""
        return self.values[:, -1] if "loop" in self._told else None

    @property
    def phase_margins(self) -> NDArray[Any]:
        """Where the gain of the loop is 1: fields frequency (Hz), margin (degrees above -180). [n_crossovers]"""
        return _margins(self._told.get("crossovers", []), "phase_margin")

    @property
    def gain_margins(self) -> NDArray[Any]:
        """Where its phase is 180 degrees: fields frequency (Hz), margin (dB by which it may grow). [n_reversals]"""
        return _margins(self._told.get("reversals", []), "gain_margin")

    def plot(self, *names: str, ax: Any = None) -> Any:
        """Draws signals in dB and degrees with matplotlib: of a loop its gain, else all without names.

        ax    two axes, for magnitudes and phases; None: new ones. Returns them
        """
        if not names and self.loop is not None:
            names = self.names[-1:]
        return self.plot_bode(*names, axes=ax)
