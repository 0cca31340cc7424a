/* circuits.h - netlists of any size for the benchmarks. Each returns text that the caller frees. */
#ifndef DALCS_BENCH_CIRCUITS_H
#define DALCS_BENCH_CIRCUITS_H

/* Diode bridge with R and C load behind a source resistance. */
char *bench_bridge(int copies);

/* Cockcroft-Walton multiplier with n stages, 50 Hz, stiff source. */
char *bench_cockcroft_walton(int n);

/* Six-pulse bridge with source inductance. */
char *bench_six_pulse(void);

/* Ladder of n cells: series diode + 1 ohm, 1 uF and 10 kohm to ground; 10 V 1 kHz through 10 ohm. */
char *bench_ladder(int n);

/* Line of n resistors from 10 V 1 kHz; each node has a diode to a capacitor with a load. */
char *bench_peak_detectors(int n);

#endif
