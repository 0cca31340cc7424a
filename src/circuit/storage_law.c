/* storage_law.c - Flux= of a coil and Q= of a capacitor as functions of its current or voltage, x: what they may be,
 * their values and inverses.
 *
 * A law that does not rise has no answer: where flux falls with current the stored energy falls with it, and a coil at
 * a constant voltage would jump. Straight lines are asked exactly, smooth functions at 16 values of x a decade. */
#include "behaviour.h"
#include "formula_writer.h"
#include "storage.h"

#include <math.h>
#include <stdlib.h>

static double raw_at(const struct dalcs_builder *builder, const struct dalcs_storage_function *f,
                     double x) {
    return f->formula != NULL ? dalcs_storage_formula_at(builder, f->formula, x)
                              : dalcs_piecewise_at(&f->curve, x, 0);
}

double dalcs_storage_function_at(const struct dalcs_builder *builder,
                                 const struct dalcs_storage_function *f, double x) {
    return (raw_at(builder, f, x) - f->at_0) / f->unit;
}

const struct dalcs_formula *dalcs_storage_function_write(struct dalcs_formula_writer *w,
                                                         const struct dalcs_storage_function *f,
                                                         const struct dalcs_formula *argument) {
    return dalcs_storage_formula_copy(w, NULL, f->formula, argument, false);
}

/* x as the variable of a formula. */
static const struct dalcs_formula *variable(struct dalcs_formula_writer *w) {
    return dalcs_formula_signal(w, DALCS_FORMULA_TIME, NULL, NULL);
}

/* ---- Piecewise linear ones --------------------------------------------------------------------------- */

/* The form as a function of one quantity: false where it is none. */
static bool is_of_one(struct dalcs_compiler *c, const struct dalcs_form *form,
                      struct dalcs_piecewise *f) {
    struct dalcs_piecewise line;
    struct dalcs_affine direction;
    double factor;
    if (form == NULL || form->n > 1) {
        return false;
    }
    if (form->n == 0) {
        factor = dalcs_affine_direction(c, &form->affine, &direction);
        return dalcs_piecewise_line(c->arena, form->affine.constant, factor, f);
    }
    return dalcs_affine_is_along(&form->affine, &form->part[0].direction, &factor) &&
           dalcs_piecewise_line(c->arena, form->affine.constant, factor, &line) &&
           dalcs_piecewise_add(c->arena, &line, &form->part[0].f, f);
}

/* The formula, of the element's own current, as straight lines; false where it is curved, or wrong. */
static bool find_lines(struct dalcs_builder *builder, const struct dalcs_token *element,
                       const struct dalcs_formula *formula, struct dalcs_piecewise *f) {
    struct dalcs_formula_writer w;
    if (!dalcs_formula_writer_start(&w, builder, element)) {
        return false;
    }
    const struct dalcs_formula *own = dalcs_storage_formula_copy(
        &w, NULL, formula, dalcs_formula_signal(&w, DALCS_FORMULA_CURRENT, element, NULL), false);
    struct dalcs_compiler c = {
        .builder = builder, .arena = &builder->scratch, .element = element, .is_silent = true};
    c.n_forms = own != NULL ? (size_t)own->number_of + 1 : 0;
    c.form_of = dalcs_arena_alloc(c.arena, c.n_forms + 1, sizeof(const struct dalcs_form *));
    bool is = own != NULL && c.form_of != NULL;
    builder->out_of_memory = builder->out_of_memory || !is;
    is = is && is_of_one(&c, dalcs_compile(&c, own), f) && !c.failed && c.n_cells == 0;
    free(c.cell);
    free(c.wave);
    free(c.stimulus);
    return is;
}

/* The integral of steps, 0 at 0. */
static bool integrate_steps(struct dalcs_arena *arena, const struct dalcs_piecewise *slope,
                            struct dalcs_piecewise *f) {
    struct dalcs_knot *knot = dalcs_arena_alloc(arena, (size_t)slope->n, sizeof *knot);
    if (knot == NULL) {
        return false;
    }
    double value = 0;
    for (int k = 0; k < slope->n; k++) {
        const double at = slope->knot[k].at;
        value += k > 0 ? slope->knot[k].left * (at - slope->knot[k - 1].at) : 0;
        knot[k] = (struct dalcs_knot){at, value, value, value};
    }
    *f = (struct dalcs_piecewise){.n = slope->n,
                                  .knot = knot,
                                  .before = slope->knot[0].left,
                                  .after = slope->knot[slope->n - 1].right};
    const double at_0 = dalcs_piecewise_at(f, 0, 0);
    for (int k = 0; k < slope->n; k++) {
        knot[k].left = knot[k].value = knot[k].right -= at_0;
    }
    return true;
}

static const struct dalcs_formula *times(struct dalcs_formula_writer *w, double factor,
                                         const struct dalcs_formula *f) {
    return dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, factor), f);
}

/* The integral of straight lines: a parabola, and at each knot one that begins there, or a ramp. */
static const struct dalcs_formula *integrate_lines(struct dalcs_formula_writer *w,
                                                   const struct dalcs_piecewise *slope) {
    const struct dalcs_formula *x = variable(w);
    const double at_0 = slope->knot[0].left - slope->before * slope->knot[0].at;
    const struct dalcs_formula *sum =
        dalcs_formula_operation(w, DALCS_ADD, times(w, at_0, x),
                                times(w, slope->before / 2, dalcs_formula_call(w, "sqr", 1, &x)));
    for (int k = 0; k < slope->n; k++) {
        const struct dalcs_knot *knot = &slope->knot[k];
        const double bend = dalcs_piecewise_slope(slope, k + 1) - dalcs_piecewise_slope(slope, k);
        if (bend == 0 && knot->right == knot->left) {
            continue;
        }
        const struct dalcs_formula *beyond =
            dalcs_formula_operation(w, DALCS_SUBTRACT, x, dalcs_formula_number(w, knot->at));
        beyond = dalcs_formula_call(w, "uramp", 1, &beyond);
        sum =
            dalcs_formula_operation(w, DALCS_ADD, sum, times(w, knot->right - knot->left, beyond));
        sum = dalcs_formula_operation(w, DALCS_ADD, sum,
                                      times(w, bend / 2, dalcs_formula_call(w, "sqr", 1, &beyond)));
    }
    return sum;
}

/* ---- What a law may be ------------------------------------------------------------------------------- */

struct wording {
    const char *what, *of, *unit; /* "flux", "current", "A" */
};

static struct wording wording_of(const struct dalcs_device *device) {
    return device->kind == DALCS_INDUCTOR ? (struct wording){"flux", "current", "A"}
                                          : (struct wording){"charge", "voltage", "V"};
}

static bool check_lines(struct dalcs_builder *builder, const struct dalcs_token *place,
                        const struct wording *word, const struct dalcs_piecewise *f) {
    for (int k = 0; k <= f->n; k++) {
        const double slope = dalcs_piecewise_slope(f, k);
        const double at = f->knot[k < f->n ? k : f->n - 1].at;
        if (k < f->n && f->knot[k].left != f->knot[k].right) {
            dalcs_builder_error(builder, place, "write a steep line in place of the jump",
                                "the %s jumps at a %s of %g %s", word->what, word->of, at,
                                word->unit);
            return false;
        }
        if (slope < 0) {
            dalcs_builder_error(builder, place, "it must rise or stay constant",
                                "the %s falls %s a %s of %g %s", word->what,
                                k < f->n ? "below" : "above", word->of, at, word->unit);
            return false;
        }
    }
    return true;
}

/* Nearer to 0 than this part of an ampere or a volt no circuit is: a law that falls there falls from 0 on. */
static const double NEAREST = 1e-8;

/* The slope around 0 of a smooth law, wherever it has one. */
static double find_unit(const struct dalcs_builder *builder,
                        const struct dalcs_storage_function *f) {
    const double at_0 = raw_at(builder, f, 0);
    double unit = 0;
    for (double x = 1e-6; x < 1e9 && !(unit > 0); x *= 1e3) {
        for (int k = 0; k < 2 && !(unit > 0); k++) {
            const double slope = (raw_at(builder, f, k == 0 ? x : -x) - at_0) / (k == 0 ? x : -x);
            unit = isfinite(slope) ? slope : 0;
        }
    }
    return unit;
}

static bool check_smooth(struct dalcs_builder *builder, const struct dalcs_token *place,
                         const struct wording *word, const struct dalcs_storage_function *f) {
    if (!isfinite(raw_at(builder, f, 0))) {
        dalcs_builder_error(builder, place, NULL, "the %s has no value at a %s of 0", word->what,
                            word->of);
        return false;
    }
    if (!(find_unit(builder, f) > 0)) {
        dalcs_builder_error(builder, place, "it has to rise", "the %s does not rise with the %s",
                            word->what, word->of);
        return false;
    }
    for (int k = 0; k < 2; k++) {
        const double fall = dalcs_storage_find_fall(builder, f, k == 0 ? 1 : -1);
        if (fall != 0 && fabs(fall) < NEAREST) {
            dalcs_builder_error(builder, place, "it has to rise", "the %s falls %s a %s of 0",
                                word->what, fall > 0 ? "above" : "below", word->of);
            return false;
        }
        if (fall != 0) {
            dalcs_builder_warn(
                builder, place,
                "write limit(x, low, high) for x to keep it constant outside of this range",
                "the %s falls %s a %s of about %.2g %s: the circuit has no solution there",
                word->what, fall > 0 ? "above" : "below", word->of, fall, word->unit);
        }
    }
    return true;
}

/* ---- From a card --------------------------------------------------------------------------------------- */

/* The law as written, of x, for m in parallel. */
static const struct dalcs_formula *read(struct dalcs_formula_writer *w,
                                        const struct dalcs_card *card,
                                        const struct dalcs_storage_law *law, double m) {
    const bool is_coil = card->letter == 'l';
    const struct dalcs_formula *x = variable(w);
    if (m != 1 && is_coil) {
        x = times(w, 1 / m, x);
    }
    const struct dalcs_formula *f =
        dalcs_storage_formula_copy(w, card, law->formula->formula, x, false);
    const double factor = !is_coil ? m : law->is_slope ? 1 / m : 1;
    return f != NULL && factor != 1 ? times(w, factor, f) : f;
}

/* What an inductance or a capacitance is the slope of. */
static bool integrate(struct dalcs_builder *builder, struct dalcs_formula_writer *w,
                      const struct dalcs_token *place, const struct wording *word,
                      struct dalcs_storage_function *f) {
    struct dalcs_piecewise slope;
    if (!find_lines(builder, w->element, f->formula, &slope)) {
        f->formula = dalcs_storage_integral(w, f->formula);
        if (f->formula != NULL) {
            return true;
        }
        if (!builder->out_of_memory) {
            dalcs_builder_error(builder, place,
                                *word->unit == 'A' ? "write Flux=, the integral of the inductance"
                                                   : "write Q=, the integral of the capacitance",
                                "there is no integral here of this function of the %s", word->of);
        }
        return false;
    }
    const bool is_stepped = dalcs_piecewise_is_stepped(&slope);
    f->formula = is_stepped ? NULL : integrate_lines(w, &slope);
    const bool ok =
        is_stepped ? integrate_steps(&builder->scratch, &slope, &f->curve) : f->formula != NULL;
    builder->out_of_memory = builder->out_of_memory || !ok;
    return ok;
}

/* What a smooth law does not choose has no part in it. False when out of memory. */
static bool guard(struct dalcs_formula_writer *w, struct dalcs_storage_function *f) {
    if (f->formula != NULL) {
        const struct dalcs_formula *guarded = dalcs_formula_guard(&w->builder->scratch, f->formula);
        f->formula = guarded != NULL
                         ? dalcs_storage_formula_copy(w, NULL, guarded, variable(w), false)
                         : NULL;
        w->builder->out_of_memory = w->builder->out_of_memory || f->formula == NULL;
    }
    return !w->builder->out_of_memory;
}

/* The slope around 0 of lines, or else the steepest. */
static double unit_of_lines(const struct dalcs_piecewise *f) {
    int base = 0;
    while (base < f->n && f->knot[base].at <= 0) {
        base++;
    }
    double unit = dalcs_piecewise_slope(f, base);
    for (int k = 0; k <= f->n && dalcs_piecewise_slope(f, base) == 0; k++) {
        unit = fmax(unit, dalcs_piecewise_slope(f, k));
    }
    return unit;
}

bool dalcs_storage_function_make(struct dalcs_builder *builder, const struct dalcs_card *card,
                                 const struct dalcs_device *device,
                                 const struct dalcs_storage_law *law, double m,
                                 struct dalcs_storage_function *f) {
    const struct wording word = wording_of(device);
    const struct dalcs_token *place = law->is_curve ? card->token : law->formula;
    struct dalcs_formula_writer w;
    *f = (struct dalcs_storage_function){.curve = law->curve};
    if (!dalcs_formula_writer_start(&w, builder, card->token)) {
        return false;
    }
    if (!law->is_curve) {
        f->formula = read(&w, card, law, m);
        if (f->formula == NULL || (law->is_slope && !integrate(builder, &w, place, &word, f)) ||
            !guard(&w, f)) {
            return false;
        }
    }
    if (f->formula != NULL && find_lines(builder, card->token, f->formula, &f->curve)) {
        f->formula = NULL;
    }
    if (builder->out_of_memory ||
        !(f->formula != NULL ? check_smooth(builder, place, &word, f)
                             : check_lines(builder, place, &word, &f->curve))) {
        return false;
    }
    f->unit = f->formula != NULL ? find_unit(builder, f) : unit_of_lines(&f->curve);
    f->at_0 = raw_at(builder, f, 0);
    if (f->formula != NULL) {
        dalcs_storage_keep_slope(&w, place, *word.unit == 'A', f);
    }
    if (!(f->unit > 0)) {
        dalcs_builder_error(builder, place, "it has to rise", "the %s does not rise with the %s",
                            word.what, word.of);
        return false;
    }
    return true;
}

bool dalcs_storage_function_invert(struct dalcs_arena *arena,
                                   const struct dalcs_storage_function *f,
                                   struct dalcs_piecewise *inverse) {
    const struct dalcs_piecewise *curve = &f->curve;
    struct dalcs_knot *knot = dalcs_arena_alloc(arena, (size_t)curve->n, sizeof *knot);
    int n = 0;
    if (knot == NULL) {
        return false;
    }
    for (int k = 0; k < curve->n; k++) {
        const double at = (curve->knot[k].value - f->at_0) / f->unit;
        const double x = curve->knot[k].at;
        if (k == 0 || dalcs_piecewise_slope(curve, k) > 0) {
            knot[n++] = (struct dalcs_knot){at, x, x, x};
        }
        knot[n - 1].right = x;
        knot[n - 1].value = fmin(fmax(0, knot[n - 1].left), x);
    }
    const double before = curve->before;
    const double after = curve->after;
    *inverse = (struct dalcs_piecewise){.n = n,
                                        .knot = knot,
                                        .before = before > 0 ? f->unit / before : (double)INFINITY,
                                        .after = after > 0 ? f->unit / after : (double)INFINITY};
    return true;
}
