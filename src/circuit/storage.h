/* storage.h - coils whose flux, and capacitors whose charge, is no straight line. Private to this folder. */
#ifndef DALCS_STORAGE_H
#define DALCS_STORAGE_H

#include "builder.h"

#include "piecewise.h"

/* What a card says of its flux or charge; NULL formula: nothing. */
struct dalcs_storage_law {
    const struct dalcs_token *formula; /* of x, its own current or voltage */
    bool is_slope;                     /* it is the inductance or the capacitance at x */
    bool is_curve;                     /* `curve` says it instead */
    struct dalcs_piecewise curve;
};

/* Makes what the law says of a coil or a capacitor, of m in parallel: parts that are added to the circuit. Its nodes are
 * those that its parasitics leave; node[0] changes. False when an error was reported, or it is an ordinary one. */
bool dalcs_storage_expand(struct dalcs_builder *builder, const struct dalcs_card *card,
                          struct dalcs_device *device, const struct dalcs_storage_law *law,
                          double m);

/* Of a law that other quantities or the time change: the element becomes a source of the derivative of its charge or
 * flux, which those are part of. False: it is another law. */
bool dalcs_storage_follow(struct dalcs_builder *builder, const struct dalcs_card *card,
                          struct dalcs_device *device, const struct dalcs_storage_law *law,
                          double m);

/* Is a device such a coil or capacitor? */
bool dalcs_storage_is(const struct dalcs_builder *builder, int device);

/* Their initial states, when all .ic cards are read. */
void dalcs_storage_resolve(struct dalcs_builder *builder);

/* ---- storage_formula.c --------------------------------------------------------------------------- */

struct dalcs_formula_writer;

/* The value at x of a formula of x, which is called time in it, or is the one voltage that it reads; NAN: it has
 * none. */
double dalcs_storage_formula_at(const struct dalcs_builder *builder, const struct dalcs_formula *f,
                                double x);

/* Does it read the time, or another signal than the card's own current or voltage? */
bool dalcs_storage_formula_follows(struct dalcs_builder *builder, const struct dalcs_card *card,
                                   const struct dalcs_formula *f);

/* A copy with another argument in the place of x, and of what a card's signals say of it; card NULL: there are none.
 * Other signals are errors unless it keeps them. NULL when an error was reported or out of memory. */
const struct dalcs_formula *dalcs_storage_formula_copy(struct dalcs_formula_writer *w,
                                                       const struct dalcs_card *card,
                                                       const struct dalcs_formula *f,
                                                       const struct dalcs_formula *argument,
                                                       bool keeps_others);

/* ---- storage_integral.c -------------------------------------------------------------------------- */

/* The integral over x of a formula of x, which is called time in it; any constant. NULL: it has none that is written
 * with functions, or out of memory. */
const struct dalcs_formula *dalcs_storage_integral(struct dalcs_formula_writer *w,
                                                   const struct dalcs_formula *f);

/* ---- storage_ends.c ------------------------------------------------------------------------------ */

struct dalcs_storage_function;

/* Where a smooth law begins to fall from 0 on in the direction of sign; 0: nowhere. It ends where it has no value. */
double dalcs_storage_find_fall(const struct dalcs_builder *builder,
                               const struct dalcs_storage_function *f, double sign);

/* A smooth law that does not rise any more somewhere rises a little, and a note says how much. */
void dalcs_storage_keep_slope(struct dalcs_formula_writer *w, const struct dalcs_token *place,
                              bool is_flux, struct dalcs_storage_function *f);

/* ---- storage_law.c ------------------------------------------------------------------------------- */

/* The flux or charge as a function of one argument. */
struct dalcs_storage_function {
    const struct dalcs_formula *formula; /* NULL: piecewise linear */
    struct dalcs_piecewise curve;
    double unit; /* H or F, of the size of its slope around 0 */
    double at_0;
};

/* Reads a law; false when an error was reported. `argument` stands for x in the formula that is made of it. */
bool dalcs_storage_function_make(struct dalcs_builder *builder, const struct dalcs_card *card,
                                 const struct dalcs_device *device,
                                 const struct dalcs_storage_law *law, double m,
                                 struct dalcs_storage_function *f);

/* Its value at x less that at 0, over its unit: A or V. */
double dalcs_storage_function_at(const struct dalcs_builder *builder,
                                 const struct dalcs_storage_function *f, double x);

/* Its formula with another argument. NULL: out of memory. */
const struct dalcs_formula *dalcs_storage_function_write(struct dalcs_formula_writer *w,
                                                         const struct dalcs_storage_function *f,
                                                         const struct dalcs_formula *argument);

/* The argument of a piecewise linear one as a function of its value as above; vertical ends have a slope of INFINITY.
 * False when out of memory. */
bool dalcs_storage_function_invert(struct dalcs_arena *arena,
                                   const struct dalcs_storage_function *f,
                                   struct dalcs_piecewise *inverse) DALCS_MUST_CHECK;

#endif
