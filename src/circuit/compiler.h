/* compiler.h - formulas to values: forms, which are affine functions plus piecewise-linear ones of one affine
 * quantity each. Private to this folder. */
#ifndef DALCS_COMPILER_H
#define DALCS_COMPILER_H

#include "builder.h"

#include "formula.h"
#include "piecewise.h"

/* A part of a value: a function of the affine quantity `direction`, which has no constant and whose
 * first coefficient is 1. */
struct dalcs_form_part {
    struct dalcs_affine direction;
    struct dalcs_piecewise f;
};

struct dalcs_form {
    struct dalcs_affine affine;
    int n;
    const struct dalcs_form_part *part;
    double height; /* not 0: the value is 0 or this, or between the two at a jump */
    const struct dalcs_levels *levels; /* where `part` does not show them, or NULL */
};

/* base + sum of heights of values of 0 and 1 */
struct dalcs_levels {
    double base;
    int n;

    struct dalcs_height {
        double height;
        const struct dalcs_form *logic;
    } * level;
};

/* exp(-decay t) sin(2 pi (frequency t + phase)) from `delay` on, 0 before; or straight lines of the same frequency and
 * phase, without decay and delay: from 0 up to 1 and there down at once, from 0 up to 1 and back. Or a random value
 * between 0 and 1 for each whole x = frequency t + phase, held until the next or with a straight line to it. */
enum dalcs_wave_shape {
    DALCS_SINE,
    DALCS_SAWTOOTH,
    DALCS_TRIANGLE,
    DALCS_HELD_NOISE,
    DALCS_LINEAR_NOISE
};

struct dalcs_wave {
    enum dalcs_wave_shape shape;
    double decay, frequency, phase, delay; /* 1/s, Hz, cycles, s */
};

/* A kink, a jump or a saturation: see dalcs_behaviour_freeze. */
struct dalcs_cell {
    struct dalcs_affine argument;
    double resistance; /* 1 / slope, 0: a jump */
    double height;     /* INFINITY: a kink, of one pair; else of two */
    double rest;       /* of a jump: the part of its height at its knot */
    int pair;          /* the first */
};

/* A source that waits for all elements to be known. */
struct dalcs_formula_source {
    int device;
    const struct dalcs_token *token; /* its formula; NULL: the voltage of its controlling nodes */
    bool has_table;
    struct dalcs_piecewise table;
    const struct dalcs_gate *gate; /* once it is compiled: the values that it has, or NULL */
    bool is_resolved;              /* or about to be */
};

struct dalcs_compiler {
    struct dalcs_builder *builder;
    struct dalcs_arena *arena;         /* of values: scratch */
    const struct dalcs_form **form_of; /* by number_of, NULL before */
    struct dalcs_wave *wave;           /* heap */
    size_t n_waves, wave_capacity;
    struct dalcs_cell *cell; /* heap */
    size_t n_cells, cell_capacity;
    int n_pairs;
    struct dalcs_stimulus *stimulus; /* heap: of all compilers, those of the circuit follow */
    size_t n_stimuli, stimulus_capacity;
    const struct dalcs_token *element; /* whose formula it is */
    size_t n_forms;                    /* room in form_of */
    int depth;                         /* of products that are parts of products */
    int n_nodes;                       /* that products made, to name them */
    int *
        smooth_node; /* [n_forms] by number_of, of the whole formula: the node that a smooth function made; 0: none */

    const struct dalcs_potentials *potentials; /* NULL: what sources decide has pairs, too */

    bool is_silent; /* a formula is only asked what it is */

    struct {
        bool is_it;   /* flux or charge */
        double start; /* its argument at the start */
    } storage;

    bool failed;
};

/* ---- affine.c: all fail, with `failed`, where memory runs out ------------------------------------ */

/* a + factor b */
struct dalcs_affine dalcs_affine_add(struct dalcs_compiler *c, const struct dalcs_affine *a,
                                     double factor, const struct dalcs_affine *b);
struct dalcs_affine dalcs_affine_of(struct dalcs_compiler *c, enum dalcs_quantity_kind kind,
                                    int index);
struct dalcs_affine dalcs_affine_constant(double constant);

/* a = constant + factor * direction, normalised; factor 0 when a is constant. */
double dalcs_affine_direction(struct dalcs_compiler *c, const struct dalcs_affine *a,
                              struct dalcs_affine *direction);
bool dalcs_affine_is_along(const struct dalcs_affine *a, const struct dalcs_affine *direction,
                           double *factor);
bool dalcs_affine_is_constant(const struct dalcs_affine *a);

/* A function of time alone that no wave takes part in? */
bool dalcs_affine_is_time(const struct dalcs_affine *a);

/* ---- form.c --------------------------------------------------------------------------------------- */

const struct dalcs_form *dalcs_form_number(struct dalcs_compiler *c, double number);
const struct dalcs_form *dalcs_form_affine(struct dalcs_compiler *c,
                                           const struct dalcs_affine *affine);
bool dalcs_form_is_number(const struct dalcs_form *v);

/* a + factor b */
const struct dalcs_form *dalcs_form_add(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        double factor, const struct dalcs_form *b);
const struct dalcs_form *dalcs_form_scale(struct dalcs_compiler *c, double factor,
                                          const struct dalcs_form *a);

/* Of values of 0 and 1: 1 - logic; a or b. */
const struct dalcs_form *dalcs_form_negated(struct dalcs_compiler *c,
                                            const struct dalcs_form *logic);
const struct dalcs_form *dalcs_form_either(struct dalcs_compiler *c, const struct dalcs_form *a,
                                           const struct dalcs_form *b);

/* 1 / a, of what has steps only, none of them to 0; NULL: it is no such value. */
const struct dalcs_form *dalcs_form_reciprocal(struct dalcs_compiler *c,
                                               const struct dalcs_form *a);

/* Of its numbers: constants, coefficients, slopes and heights. */
double dalcs_form_largest(const struct dalcs_form *v);

/* outer(a) */
const struct dalcs_form *dalcs_form_apply(struct dalcs_compiler *c,
                                          const struct dalcs_piecewise *outer,
                                          const struct dalcs_form *a);
const struct dalcs_form *dalcs_form_max(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        const struct dalcs_form *b);
const struct dalcs_form *dalcs_form_min(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        const struct dalcs_form *b);

/* 1 where a is not 0; NULL where a is not constant between jumps. */
const struct dalcs_form *dalcs_form_to_logic(struct dalcs_compiler *c, const struct dalcs_form *a);

enum dalcs_product { DALCS_PRODUCT_IS, DALCS_PRODUCT_HAS_JUMP, DALCS_PRODUCT_IS_CURVED };

/* a b where that is piecewise linear, into *product. */
enum dalcs_product dalcs_form_multiply(struct dalcs_compiler *c, const struct dalcs_form *a,
                                       const struct dalcs_form *b,
                                       const struct dalcs_form **product);

/* ---- levels.c: numbers and steps ------------------------------------------------------------------ */

/* NULL: the value is no such sum, or too long a one. */
const struct dalcs_levels *dalcs_levels_of(struct dalcs_compiler *c, const struct dalcs_form *v);

/* Those of a + factor b that the sum itself does not show. */
const struct dalcs_levels *dalcs_levels_add(struct dalcs_compiler *c, const struct dalcs_form *a,
                                            double factor, const struct dalcs_form *b);

/* a b, where both are such sums. */
bool dalcs_levels_multiply(struct dalcs_compiler *c, const struct dalcs_form *a,
                           const struct dalcs_form *b, const struct dalcs_form **product);

/* ---- form.c, for form_functions.c ----------------------------------------------------------------- */

/* A copy that lives as long as what is compiled; NULL: out of memory, or the compilation failed. */
const struct dalcs_form *dalcs_form_keep(struct dalcs_compiler *c, struct dalcs_form value);

bool dalcs_form_check(struct dalcs_compiler *c, bool ok);

/* Adds factor * f(direction) to a list that has room: a line goes to *affine. */
bool dalcs_form_add_part(struct dalcs_compiler *c, struct dalcs_affine *affine,
                         struct dalcs_form_part *part, int *n, double factor,
                         const struct dalcs_form_part *other);

/* Is it a staircase of one quantity, and a number? */
bool dalcs_form_is_staircase(const struct dalcs_form *v);

/* It is 0 or 1, or between the two at a jump. */
const struct dalcs_form *dalcs_form_mark_logic(struct dalcs_compiler *c,
                                               const struct dalcs_form *v);

/* ---- compile.c and compile_call.c ----------------------------------------------------------------- */

/* Reports that this part of a formula cannot be, once; NULL. */
const struct dalcs_form *dalcs_compile_refuse(struct dalcs_compiler *c,
                                              const struct dalcs_formula *f, const char *hint,
                                              const char *what);

/* The same with its name in the sentence. */
const struct dalcs_form *dalcs_compile_refuse_name(struct dalcs_compiler *c,
                                                   const struct dalcs_formula *f, const char *hint,
                                                   const char *format);

/* 1 where a is below b, else 0. */
const struct dalcs_form *dalcs_compile_compare(struct dalcs_compiler *c, const struct dalcs_form *a,
                                               const struct dalcs_form *b, double at_0);

/* A call of a function. */
const struct dalcs_form *dalcs_compile_call(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                            const struct dalcs_form **argument);

#endif
