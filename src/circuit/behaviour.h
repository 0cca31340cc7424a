/* behaviour.h - formulas of voltages, currents and time to complementarity pairs.
 *
 *     formula -> value: an affine function plus piecewise-linear ones, each of one affine quantity
 *             -> behaviour: an affine function of voltages, currents, stimuli and lambdas, and a pair
 *                0 <= lambda _|_ w >= 0 for every kink, two for every jump and every saturation
 *
 * doc/theory.md, section 10, has the pairs. Private to this folder. */
#ifndef DALCS_BEHAVIOUR_H
#define DALCS_BEHAVIOUR_H

#include "compiler.h"

/* ---- gate_levels.c -------------------------------------------------------------------------------- */

/* The values that a source of this form has; NULL: any, or too many. */
const struct dalcs_gate *dalcs_gate_find(struct dalcs_compiler *c,
                                         const struct dalcs_device *device,
                                         const struct dalcs_form *form);

/* The first of its two nodes. */
int dalcs_gate_node(const struct dalcs_gate *gate);

/* Between which values v(node, reference) is, if the gate is between these nodes; false: it is not. */
bool dalcs_gate_bounds(const struct dalcs_gate *gate, int node, int reference, double *low,
                       double *high);

/* What each node controls, once all devices are there. Heap; zero-initialise. */
struct dalcs_gate_readers {
    int *
        first; /* [n_nodes] a control: of the kth, 2 device + which of its two nodes + 1; 0: none */
    int (*next)[2]; /* [n_devices] of the same node, by which of the device's two it is */
};

/* Switches without hysteresis that this gate commands, and a Vt that is one of its values. */
void dalcs_gate_settle(struct dalcs_builder *builder, struct dalcs_gate_readers *readers,
                       const struct dalcs_gate *gate);
void dalcs_gate_readers_finish(struct dalcs_gate_readers *readers);

/* ---- carrier.c ------------------------------------------------------------------------------------ */

/* A sawtooth, a triangle or a staircase of time; NULL: something else, or out of memory. */
/* A multiple of one voltage and a number, where the source of its node has two values; NULL: it has others. */
const struct dalcs_form *dalcs_commutation_steps(struct dalcs_compiler *c,
                                                 const struct dalcs_formula *f,
                                                 const struct dalcs_form *form);

/* delay(x, t) (delay.c). */
size_t dalcs_delay_pending(const struct dalcs_builder *builder); /* stimuli that they will have */
bool dalcs_delay_is(const struct dalcs_formula *f);
const struct dalcs_form *dalcs_delay_form(struct dalcs_compiler *c, const struct dalcs_formula *f);

/* rand(x), random(x) and white(x) of a straight line in time (noise.c). NULL: it is another formula, or an error. */
const struct dalcs_form *dalcs_noise_form(struct dalcs_compiler *c, const struct dalcs_formula *f);

/* The stimulus of such a wave, up to the end of the run; -1 when out of memory. */
int dalcs_noise_stimulus(struct dalcs_compiler *c, const struct dalcs_wave *wave);

const struct dalcs_form *dalcs_carrier(struct dalcs_compiler *c, const struct dalcs_formula *f);

/* offset + height times the fraction of frequency t + phase, which may fall. */
const struct dalcs_form *dalcs_carrier_ramp(struct dalcs_compiler *c, const struct dalcs_wave *saw,
                                            double height, double offset);

/* ---- wave.c: functions of time --------------------------------------------------------------------- */

/* sin(2 pi (frequency t + phase)) exp(-decay t) as a value. */
const struct dalcs_form *dalcs_wave_value(struct dalcs_compiler *c, const struct dalcs_wave *wave);

/* The product of two waves, a sum of two others; false where one begins later than the other or has lines. */
bool dalcs_wave_multiply(struct dalcs_compiler *c, int a, int b, const struct dalcs_form **product);

/* A wave that begins at a time; -1: a damped one, one of lines, or out of memory. */
int dalcs_wave_delayed(struct dalcs_compiler *c, int wave, double delay);

/* Its number among those of the circuit; -1: out of memory. */
int dalcs_compiler_add_stimulus(struct dalcs_compiler *c, const struct dalcs_stimulus *stimulus);

/* The stimulus of a wave, and of a piecewise-linear function of time; -1: out of memory. */
int dalcs_wave_stimulus(struct dalcs_compiler *c, int wave);
int dalcs_time_stimulus(struct dalcs_compiler *c, const struct dalcs_piecewise *f);

/* ---- decided.c: formulas of sources alone ---------------------------------------------------------- */

/* What sources alone make of the voltages of nodes. */
struct dalcs_potentials {
    int n;       /* nodes */
    int *device; /* [n] from each that is decided towards ground, and 1; 0: none */
};

/* Those that V sources decide. Heap; zero-initialise. */
void dalcs_potentials_find(struct dalcs_potentials *p, struct dalcs_builder *builder);

/* Of a source with a formula, where that is decided. */
void dalcs_potentials_note(struct dalcs_potentials *p, const struct dalcs_circuit *circuit,
                           int device);

/* Does a behaviour read what is decided? */
bool dalcs_potentials_reach(const struct dalcs_potentials *p,
                            const struct dalcs_behaviour *behaviour);
void dalcs_potentials_finish(struct dalcs_potentials *p);

/* f(argument) as a stimulus, NULL: the argument itself; false where other things than sources decide it. */
bool dalcs_decided(struct dalcs_compiler *c, const struct dalcs_affine *argument,
                   const struct dalcs_piecewise *f, struct dalcs_affine *stimulus);

/* ---- pairs.c --------------------------------------------------------------------------------------- */

/* The value as an affine function of quantities and lambdas. */
struct dalcs_affine dalcs_behaviour_freeze(struct dalcs_compiler *c, const struct dalcs_form *v);

/* Freezes the output and makes the behaviour, in the circuit's arena; NULL when out of memory. */
struct dalcs_behaviour *dalcs_behaviour_make(struct dalcs_compiler *c,
                                             const struct dalcs_form *output);

/* ---- inner_parts.c --------------------------------------------------------------------------------- */

/* A compiler of a part of the formula, as the formula of a source of its own: pairs are those of one device. */
bool dalcs_compiler_start_inner(struct dalcs_compiler *c, struct dalcs_compiler *inner,
                                size_t n_forms);
void dalcs_compiler_finish_inner(struct dalcs_compiler *c, struct dalcs_compiler *inner);

/* ---- smooth_parts.c -------------------------------------------------------------------------------- */

/* The value of a formula's part f that is a smooth function of its arguments, by a source that is added to the circuit:
 * the array of devices moves. argument[n]: what they are. NULL: an error, or the formula is only asked what it is. */
const struct dalcs_form *dalcs_smooth_form(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                           enum dalcs_smooth_kind kind, int n,
                                           const struct dalcs_form **argument);

/* A smooth function of the voltages of n nodes, as the source `what` of an element: its node; -1 after an error. */
int dalcs_smooth_add(struct dalcs_builder *builder, const struct dalcs_token *element,
                     const char *what, enum dalcs_smooth_kind kind, int n, const int *node_of);

/* A node of its own at the value of a part of the formula, from a source to ground: its number among devices. is_part:
 * as that of a behaviour. And a node alone. -1 after an error. */
int dalcs_compiler_node_at(struct dalcs_compiler *c, const char *what,
                           const struct dalcs_formula *f, bool is_part, int *source);
int dalcs_compiler_new_node(struct dalcs_compiler *c, const char *what);

/* A source from `node` to ground; -1 after an error. */
int dalcs_compiler_add_source(struct dalcs_compiler *c, const char *what, int node,
                              const struct dalcs_behaviour *behaviour);

/* ---- root_parts.c ---------------------------------------------------------------------------------- */

struct dalcs_root {
    int sign; /* of its argument, where that is not 0 */
    int node
        [3]; /* of what is held on one side of 0, of the root of that, of what it is on this side */
};

/* Is it a root of what is 0 on one side? Then what it reads, *smooth, and behind the source of that its last part; false
 * after an error. */
bool dalcs_root_is_one_sided(const struct dalcs_compiler *c, enum dalcs_smooth_kind kind,
                             const struct dalcs_form **argument);
bool dalcs_root_begin(struct dalcs_compiler *c, const struct dalcs_formula *f,
                      const struct dalcs_form **argument, struct dalcs_smooth *smooth,
                      struct dalcs_root *root);
bool dalcs_root_finish(struct dalcs_compiler *c, struct dalcs_root *root, int node);

/* ---- memory_parts.c -------------------------------------------------------------------------------- */

/* Is a part of a formula a derivative or an integral? Its value, by parts that are added to the circuit as those of
 * smooth functions are. */
bool dalcs_memory_is(const struct dalcs_formula *f);
const struct dalcs_form *dalcs_memory_form(struct dalcs_compiler *c, const struct dalcs_formula *f);

/* A device of the compiler's element between two nodes; NULL after an error. */
struct dalcs_device *dalcs_memory_add_device(struct dalcs_compiler *c, enum dalcs_device_kind kind,
                                             const char *what, int from, int to);

/* ---- wrapped_integral.c ---------------------------------------------------------------------------- */

/* idtmod(x, first, modulus, offset), whose integral begins at `first`. */
const struct dalcs_form *dalcs_wrapped_integral_form(struct dalcs_compiler *c,
                                                     const struct dalcs_formula *f, double first);

/* ---- formula_range.c ------------------------------------------------------------------------------- */

struct dalcs_range {
    double low, high; /* -INFINITY, INFINITY: not known */
};

struct dalcs_range dalcs_formula_range(const struct dalcs_compiler *c,
                                       const struct dalcs_formula *f);

/* ---- staircase.c ----------------------------------------------------------------------------------- */

/* int(x), floor(x), ... and remainders; argument: what they are of. */
bool dalcs_staircase_is(const struct dalcs_formula *f);
const struct dalcs_form *dalcs_staircase_form(struct dalcs_compiler *c,
                                              const struct dalcs_formula *f,
                                              const struct dalcs_form **argument);

/* ---- commutate.c ----------------------------------------------------------------------------------- */

/* steps (quantity - less); less NULL: nothing. A condition is 1 where it is not 0. */
struct dalcs_commutation {
    const struct dalcs_formula *of; /* the choice; NULL: a product */
    const struct dalcs_formula *steps, *quantity, *less;
    bool is_condition; /* of a choice: 0 where it is false, 1 where it is true */
    bool is_opposite;  /* or the other way round */
    bool is_over;      /* 1 over the steps */
};

/* The product, made by parts that are added to the circuit: the array of devices moves. NULL: the first
 * factor does not consist of steps, or an error. */
const struct dalcs_form *dalcs_commutate(struct dalcs_compiler *c,
                                         const struct dalcs_commutation *what);

/* The formula of a source, NULL: it has none, or a table. */
const struct dalcs_formula *dalcs_behavioural_formula_of(const struct dalcs_builder *builder,
                                                         int device);

/* ---- compile.c ------------------------------------------------------------------------------------- */

/* The value of a formula; NULL when an error was reported or out of memory. */
const struct dalcs_form *dalcs_compile(struct dalcs_compiler *c,
                                       const struct dalcs_formula *formula);

/* As a condition: what is not 0, and in LTspice what is above 0.5 (its help, of conversion to Boolean). NULL: it is true
 * unless a quantity is exactly 0. */
const struct dalcs_form *dalcs_compile_truth(struct dalcs_compiler *c, const struct dalcs_form *a);

#endif
