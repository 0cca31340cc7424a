"""How what is measured of a steady state follows from the values of the circuit."""

from __future__ import annotations

from typing import Any, Dict, Iterator, Mapping, Tuple

import numpy as np
from numpy.typing import NDArray

from ._names import no_such


def _label_of(result: Mapping[str, Any]) -> str:
    """"vout" of a measurement, "average v(out)", "magnitude 3 v(out)"."""
    if result["kind"] == "measurement":
        return str(result["name"])
    harmonic = [str(result["harmonic"])] if "harmonic" in result else []
    return " ".join(word for word in (result["kind"], *harmonic, result["name"]) if word)


class Sensitivities:
    """A table of derivatives, one row for each of m results, one column for each of p values.

    parameters    the values by name, "l1", "ton", "dmod(vfwd)": SI units
    results       names of the rows: "vout" of .meas, "average v(out)", "rms i(l1)", "magnitude 3 v(out)"
    values        [m] of the results
    derivatives   [m, p] by the values, in their units; NaN where there is none, as at a corner
    relative      [m, p] per cent by one per cent of a value; NaN where the result is 0

    table["vout"] is a row as a dict by parameter.

    >>> import dalcs
    >>> found = dalcs.steady('''A divider behind a square wave
    ... V1 in 0 PULSE(0 10 0 0 0 5u 10u)
    ... R1 in out 1k
    ... R2 out 0 1k
    ... C1 out 0 10n
    ... .meas pss mean avg v(out)
    ... ''', sensitivities=True).sensitivities
    >>> f"{1e3 * found['mean']['r1']:.3f} V by 1 kOhm"
    '-1.250 V by 1 kOhm'
    >>> dict(zip(found.parameters, abs(found.relative[found.results.index("mean")]).round(6).tolist()))
    {'r1': 0.5, 'r2': 0.5, 'c1': 0.0}
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.parameters: Dict[str, float] = dict(found["parameters"])
        rows = {_label_of(result): result for result in found["results"]}
        self.results: Tuple[str, ...] = tuple(rows)
        self.values: NDArray[Any] = np.array([row["value"] for row in rows.values()], dtype=float)
        table = [[row["derivatives"].get(name, np.nan) for name in self.parameters] for row in rows.values()]
        self.derivatives: NDArray[Any] = np.array(table, dtype=float).reshape(len(rows), len(self.parameters))

    @property
    def relative(self) -> NDArray[Any]:
        """[m, p] per cent by one per cent of a value."""
        scale = np.array(list(self.parameters.values()))
        size = np.where(self.values == 0.0, np.nan, self.values)
        return np.asarray(self.derivatives * scale[None, :] / size[:, None])

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[str]:
        return iter(self.results)

    def __getitem__(self, result: str) -> Dict[str, float]:
        if result not in self.results:
            raise no_such("result", result, self.results)
        return dict(zip(self.parameters, self.derivatives[self.results.index(result)].tolist()))

    def to_pandas(self, relative: bool = False) -> Any:
        """A pandas.DataFrame, one row a result and one column a value: derivatives, or relative ones."""
        import pandas  # pylint: disable=import-outside-toplevel
        return pandas.DataFrame(self.relative if relative else self.derivatives, index=list(self.results),
                                columns=list(self.parameters))

    def __repr__(self) -> str:
        return f"<sensitivities of {', '.join(self.results)} by {', '.join(self.parameters)}>"
