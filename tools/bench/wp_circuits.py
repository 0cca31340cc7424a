"""The circuits of the work-precision table."""

import dataclasses
import pathlib

import large_circuits

HERE = pathlib.Path(__file__).resolve().parent
EXACT = "exact from event to event in 100 decimal digits"


@dataclasses.dataclass(frozen=True)
class Circuit:
    name: str
    title: str
    period: float  # s, what ngspice's steps are counted in
    euler: tuple  # steps, s
    reference: str = EXACT
    unit: float = 0.0  # s, longest step of the exact reference; 0: stop/1000
    grid: float = 0.0  # s, output times are multiples; 0: any
    siconos: tuple = ()  # (theta, step)
    large: bool = False

    @property
    def gated(self):
        return "pulse(" in self.text().lower()

    def text(self):
        if self.large:
            return large_circuits.text(self.name)
        return (HERE / "circuits" / f"{self.name}.cir").read_text(encoding="utf-8")

    def values(self):
        return HERE / "reference_values" / f"{self.name}.csv"


SICONOS = ((1.0, 1e-6), (1.0, 1e-7), (0.5, 1e-6), (0.5, 2e-7), (0.5, 5e-8))
CIRCUITS = (
    Circuit("half_wave_rc", "Half-wave RC, 0.2 s", 2e-2, (1e-4, 1e-5, 1e-6, 2e-7)),
    Circuit("full_bridge_rc", "Bridge RC, 0.2 s", 2e-2, (1e-4, 1e-5, 1e-6, 2e-7)),
    Circuit("six_pulse", "Six-pulse, 60 ms", 2e-2, (2e-5, 2e-6, 2e-7),
            "exact, of an independent event-driven solver in 420-bit arithmetic"),
    Circuit("buck", "Buck, 100 kHz, 10 ms", 1e-5, (1e-6, 1e-7, 1e-8), unit=2e-6),
    Circuit("boost", "Boost, 100 kHz, 10 ms", 1e-5, (1e-6, 1e-7, 1e-8), unit=2e-6),
    Circuit("buck_dcm", "Buck, discontinuous, 5 ms", 1e-5, (1e-7, 1e-8, 5e-9), unit=2e-6),
    Circuit("llc", "LLC, 100 kHz, 1 ms", 1e-5, (1e-7, 1e-8, 1e-9), unit=1e-6),
    Circuit("cockcroft_walton_10", "Cockcroft-Walton 10, 20 ms", 1e-3, (1e-5, 1e-6, 1e-7),
            unit=2e-5),
    Circuit("lc_bridge", "LC tank, bridge, 5 ms", 6.28e-4, (1e-6, 1e-7, 1e-8, 2e-9), grid=1e-6,
            siconos=SICONOS),
    Circuit("lc_bridge_capfilter", "LC tank, bridge, filter, 5 ms", 6.28e-4,
            (1e-6, 1e-7, 1e-8, 2e-9), grid=1e-6, siconos=SICONOS),
    Circuit("cockcroft_walton_100", "Cockcroft-Walton 100, 0.4 ms", 2e-5, (2e-6, 4e-7, 1e-7),
            "implicit Euler extrapolated", grid=2e-7, large=True),
    Circuit("cockcroft_walton_1000", "Cockcroft-Walton 1000, 0.4 ms", 2e-5, (4e-6, 2e-6, 4e-7),
            "implicit Euler extrapolated", grid=4e-7, large=True),
    Circuit("peak_detectors_1000", "1000 peak detectors, 2 ms", 1e-3, (4e-6, 2e-6, 4e-7),
            "implicit Euler extrapolated", grid=1e-7, large=True),
)
