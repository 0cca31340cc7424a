"""libdalcs as ctypes sees it: where it is, its calls, the one struct that is read from here.

The names and the layout are those of dalcs.h; a test compares them with the header.
"""

from __future__ import annotations

import ctypes
import os
from ctypes import CFUNCTYPE, POINTER, c_bool, c_char_p, c_double, c_int, c_size_t, c_void_p

from . import _where

OK, SINGULAR, NOT_CONVERGED, INFEASIBLE, REFUTED = 0, 1, 2, 3, 4
E_NOMEM, E_NETLIST, E_OPTION, E_CANCELLED, E_INTERNAL = -1, -3, -4, -6, -7

ANALYSES = ("op", "tran", "dc", "ac", "pss", "tf")
UNITS = ("V", "A", "s", "Hz", "ohm", "")
LEVELS = ("note", "warning", "error")
FORMS = {"dalcs": 0, "lcs": 1, "osnsp": 2}


class Plot(ctypes.Structure):
    """struct dalcs_plot"""

    _fields_ = [
        ("analysis", c_int),
        ("title", c_char_p),
        ("scale", c_char_p),
        ("scale_unit", c_int),
        ("n_signals", c_size_t),
        ("name", POINTER(c_char_p)),
        ("unit", POINTER(c_int)),
        ("is_complex", c_bool),
        ("step", c_size_t),
        ("n_steps", c_size_t),
        ("n_parameters", c_size_t),
        ("parameter", POINTER(c_char_p)),
        ("parameter_value", POINTER(c_double)),
    ]


class RowTable(ctypes.Structure):
    """struct dalcs_row_table"""

    _fields_ = [
        ("plot", Plot),
        ("n_rows", c_size_t),
        ("scale", c_void_p),
        ("value", c_void_p),
    ]


class Measurement(ctypes.Structure):
    """struct dalcs_measurement; its details are read from the report"""

    _fields_ = [
        ("name", c_char_p),
        ("step", c_char_p),
        ("found", c_bool),
        ("value", c_double),
        ("failure", c_char_p),
        ("n_details", c_int),
        ("detail", c_double * 4),
    ]


class Sink(ctypes.Structure):
    """struct dalcs_sink"""

    _fields_ = [
        ("user", c_void_p),
        ("begin", c_void_p),
        ("row", c_void_p),
        ("end", c_void_p),
        ("progress", c_void_p),
        ("rows", c_void_p),
    ]


class Exchange(ctypes.Structure):
    """struct dalcs_exchange"""

    _fields_ = [
        ("time", c_double),
        ("n_signals", c_size_t),
        ("n_inputs", c_size_t),
        ("name", POINTER(c_char_p)),
        ("value", POINTER(c_double)),
        ("input", POINTER(c_char_p)),
        ("given", POINTER(c_double)),
        ("next", c_double),
    ]


Exchanging = CFUNCTYPE(c_int, c_void_p, POINTER(Exchange))
Progress = CFUNCTYPE(c_int, c_void_p, c_double, c_double)

# name: (result, arguments)
CALLS = {
    "dalcs_version": (c_char_p, ()),
    "dalcs_status_text": (c_char_p, (c_int,)),
    "dalcs_session_create": (c_int, (POINTER(c_void_p),)),
    "dalcs_session_destroy": (None, (c_void_p,)),
    "dalcs_session_set_dialect": (c_int, (c_void_p, c_char_p)),
    "dalcs_session_set_seed": (c_int, (c_void_p, c_double)),
    "dalcs_session_step_parameter": (c_char_p, (c_void_p, c_size_t, c_size_t, POINTER(c_double))),
    "dalcs_session_drawn": (c_char_p, (c_void_p, c_size_t, POINTER(c_double))),
    "dalcs_session_ask_steady": (c_int, (c_void_p,)),
    "dalcs_session_ask_response": (c_int, (c_void_p,)),
    "dalcs_session_ask_sensitivities": (c_int, (c_void_p,)),
    "dalcs_session_ask_losses": (c_int, (c_void_p, c_double, c_double)),
    "dalcs_session_keep_netlist": (c_int, (c_void_p,)),
    "dalcs_session_read_file": (c_int, (c_void_p, c_char_p)),
    "dalcs_session_read_text": (c_int, (c_void_p, c_char_p, c_char_p, c_size_t)),
    "dalcs_session_n_messages": (c_size_t, (c_void_p,)),
    "dalcs_session_message": (c_char_p, (c_void_p, c_size_t, POINTER(c_int))),
    "dalcs_session_set_value": (c_int, (c_void_p, c_char_p, c_double)),
    "dalcs_session_apply_values": (c_int, (c_void_p,)),
    "dalcs_session_parameter": (c_int, (c_void_p, c_char_p, POINTER(c_double))),
    "dalcs_session_couple": (c_int, (c_void_p, Exchanging, c_void_p)),
    "dalcs_session_set_state": (c_int, (c_void_p, c_char_p, c_double)),
    "dalcs_session_parameter_name": (c_char_p, (c_void_p, c_size_t)),
    "dalcs_session_element_name": (c_char_p, (c_void_p, c_size_t)),
    "dalcs_run_option_name": (c_char_p, (c_size_t,)),
    "dalcs_run_options_create": (c_int, (POINTER(c_void_p),)),
    "dalcs_run_options_destroy": (None, (c_void_p,)),
    "dalcs_run_options_set": (c_int, (c_void_p, c_char_p, c_char_p)),
    "dalcs_run_options_set_times": (None, (c_void_p, c_void_p, c_size_t)),
    "dalcs_run_options_set_frequencies": (None, (c_void_p, c_void_p, c_size_t)),
    "dalcs_session_run": (c_int, (c_void_p, c_void_p, c_void_p)),
    "dalcs_session_measurement": (POINTER(Measurement), (c_void_p, c_size_t)),
    "dalcs_session_run_tables": (c_int, (c_void_p, c_void_p, Progress, c_void_p,
                                         POINTER(c_void_p))),
    "dalcs_session_cancel": (None, (c_void_p,)),
    "dalcs_tables_count": (c_size_t, (c_void_p,)),
    "dalcs_tables_get": (POINTER(RowTable), (c_void_p, c_size_t)),
    "dalcs_tables_destroy": (None, (c_void_p,)),
    "dalcs_session_report_json": (c_int, (c_void_p, POINTER(c_char_p))),
    "dalcs_session_check_json": (c_int, (c_void_p, c_double, POINTER(c_char_p))),
    "dalcs_parse_number": (c_int, (c_char_p, POINTER(c_double))),
    "dalcs_session_equations_json": (c_int, (c_void_p, c_int, c_double, POINTER(c_char_p))),
}


def _load() -> ctypes.CDLL:
    """$DALCS_LIBRARY, else the one this module was built with, else the one the system finds."""
    named = os.environ.get("DALCS_LIBRARY")
    built = _where.LIBRARY if os.path.exists(_where.LIBRARY) else _where.NAME
    library = ctypes.CDLL(named or built)
    for name, (result, arguments) in CALLS.items():
        call = getattr(library, name, None)
        if call is None:
            raise ImportError(f"{library._name} is another version of libdalcs: it has no {name}")
        call.restype, call.argtypes = result, arguments
    return library


lib = _load()


def _option_names() -> frozenset[str]:
    names, index = [], 0
    while (name := lib.dalcs_run_option_name(index)) is not None:
        names.append(name.decode())
        index += 1
    return frozenset(names)


OPTIONS = _option_names()
