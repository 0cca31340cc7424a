"""The complementarity system of a netlist as matrices."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Mapping, Tuple

import numpy as np

from ._names import no_such

_ROWS = {"P": "x", "A_I": "x", "B_I": "x", "Bbar_I": "x", "E_I": "x", "constant_I": "x",
         "A_II": "z", "B_II": "z", "Bbar_II": "z", "E_II": "z", "constant_II": "z",
         "C_I": "w", "C_II": "w", "D": "w", "F": "w", "constant_F": "w", "storage": "x"}
_COLUMNS = {"P": "x", "A_I": "x", "B_I": "z", "Bbar_I": "w", "E_I": "s", "constant_I": "1",
            "A_II": "x", "B_II": "z", "Bbar_II": "w", "E_II": "s", "constant_II": "1",
            "C_I": "x", "C_II": "z", "D": "w", "F": "s", "constant_F": "1", "storage": "x"}


def _matrix(entries: Mapping[str, Any], shape: Tuple[int, int]) -> Any:
    """scipy.sparse.csr_matrix, or a dense array where there is no SciPy."""
    row = np.array(entries.get("row", []), dtype=int) - 1
    column = np.array(entries.get("column", []), dtype=int) - 1
    value = np.array(entries.get("value", []), dtype=float)
    try:
        from scipy import sparse  # pylint: disable=import-outside-toplevel
        return sparse.csr_matrix((value, (row, column)), shape=shape)
    except ImportError:
        dense = np.zeros(shape)
        np.add.at(dense, (row, column), value)
        return dense


class System:
    """One connected part of a circuit, with n_x states, n_z unknowns, n_w pairs, n_s sources:

        P x' = A_I  x + B_I  z + Bbar_I  lambda + E_I  s(t) + constant_I
           0 = A_II x + B_II z + Bbar_II lambda + E_II s(t) + constant_II
           w = C_I  x + C_II z + D       lambda + F    s(t) + constant_F,  0 <= lambda _|_ w >= 0

    states, unknowns, pairs, inputs   names of x, z, lambda and s
    system["A_I"]                     a matrix, [n_x, n_x] and so on
    """

    def __init__(self, entry: Mapping[str, Any]) -> None:
        named: Dict[str, List[str]] = {"state": [], "unknown": [], "pair": [], "inputs": []}
        for card in entry["cards"]:
            if card[0] == "inputs":
                named["inputs"] = card[1:]
            elif card[0] in named:
                named[card[0]].append(card[1])
            elif card[0] in ("switch", "interval", "free"):
                named["pair"].append(card[1])
        self.states, self.unknowns = tuple(named["state"]), tuple(named["unknown"])
        self.pairs, self.inputs = tuple(named["pair"]), tuple(named["inputs"])
        size = {"x": len(self.states), "z": len(self.unknowns), "w": len(self.pairs),
                "s": len(self.inputs), "1": 1}
        self.matrices: Dict[str, Any] = {
            name: _matrix(entry["matrices"].get(name, {}), (size[rows], size[_COLUMNS[name]]))
            for name, rows in _ROWS.items()}

    def __getitem__(self, name: str) -> Any:
        if name not in self.matrices:
            raise no_such("matrix", name, self.matrices)
        return self.matrices[name]

    def __repr__(self) -> str:
        return (f"<system of {len(self.states)} states, {len(self.unknowns)} unknowns, "
                f"{len(self.pairs)} pairs, {len(self.inputs)} inputs>")


def systems_of(text: str) -> List[System]:
    """The parts of the first network of a system file as JSON."""
    return [System(entry) for entry in json.loads(text)["networks"][0]["systems"]]
