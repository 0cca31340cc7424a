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
#include <string.h>

/* ---- Values ---------------------------------------------------------------------------------------- */

/* Of a formula of x, which is a time in it; NAN: it has none. */
static double value_at(const struct dalcs_builder *builder, const struct dalcs_formula *f, double x);

static double operate(enum dalcs_operation_code code, double a, double b) {
    switch (code) {
    case DALCS_NEGATE:
        return -a;
    case DALCS_NOT:
        return a == 0 ? 1 : 0;
    case DALCS_ADD:
        return a + b;
    case DALCS_SUBTRACT:
        return a - b;
    case DALCS_MULTIPLY:
        return a * b;
    case DALCS_DIVIDE:
        return a / b;
    case DALCS_POWER:
        return pow(a, b);
    case DALCS_LESS:
        return a < b ? 1 : 0;
    case DALCS_LESS_EQUAL:
        return a <= b ? 1 : 0;
    case DALCS_GREATER:
        return a > b ? 1 : 0;
    case DALCS_GREATER_EQUAL:
        return a >= b ? 1 : 0;
    case DALCS_TO_LOGIC:
        return a != 0 ? 1 : 0;
    case DALCS_JUMP_AND:
        return a != 0 && b != 0 ? 1 : 0;
    case DALCS_JUMP_OR:
        return a != 0 || b != 0 ? 1 : 0;
    default:
        return (double)NAN; /* the compiler of formulas refuses it */
    }
}

static double call_at(const struct dalcs_builder *builder, const struct dalcs_formula *f, double x) {
    const struct dalcs_function *function =
        dalcs_function_find(f->function, builder->netlist->dialect.name);
    double few[8];
    double *argument = f->n <= 8 ? few : dalcs_alloc((size_t)f->n, sizeof *argument);
    double value = (double)NAN;
    if (function != NULL && argument != NULL) {
        for (int k = 0; k < f->n; k++) {
            argument[k] = value_at(builder, f->argument[k], x);
        }
        value = function->one != NULL    ? function->one(argument[0])
                : function->two != NULL  ? function->two(argument[0], argument[1])
                : function->many != NULL ? function->many(argument, f->n)
                                         : value;
    }
    if (argument != few) {
        free(argument);
    }
    return value;
}

static double value_at(const struct dalcs_builder *builder, const struct dalcs_formula *f, double x) {
    double a;
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
        return f->number;
    case DALCS_FORMULA_TIME:
        return x;
    case DALCS_FORMULA_OPERATION:
        a = value_at(builder, f->argument[0], x);
        return operate(f->code, a, f->n > 1 ? value_at(builder, f->argument[1], x) : 0);
    case DALCS_FORMULA_CHOICE:
        a = value_at(builder, f->argument[0], x);
        return value_at(builder, f->argument[a != 0 ? 1 : 2], x);
    case DALCS_FORMULA_CALL:
        return call_at(builder, f, x);
    default:
        return (double)NAN;
    }
}

static double raw_at(const struct dalcs_builder *builder, const struct dalcs_storage_function *f,
                     double x) {
    return f->formula != NULL ? value_at(builder, f->formula, x)
                              : dalcs_piecewise_at(&f->curve, x, 0);
}

double dalcs_storage_function_at(const struct dalcs_builder *builder,
                                 const struct dalcs_storage_function *f, double x) {
    return (raw_at(builder, f, x) - f->at_0) / f->unit;
}

/* ---- A formula with another argument ----------------------------------------------------------------- */

struct copying {
    struct dalcs_formula_writer *w;
    const struct dalcs_formula **copy; /* by number_of, NULL before */
    const struct dalcs_formula *argument;

    /* What stands for the argument besides x; card NULL: nothing */
    const struct dalcs_card *card;
    bool failed;
};

static bool is_name(const struct dalcs_token *token, const struct dalcs_token *other) {
    const char *text = token != NULL ? token->text : "0";
    return strcmp(text, other->text) == 0 ||
           (strcmp(text, "gnd") == 0 && strcmp(other->text, "0") == 0);
}

/* The argument as a signal names it: 1, or -1 where it is turned around; 0: it is another. */
static int direction_of(const struct copying *c, const struct dalcs_formula *f) {
    const struct dalcs_token *token = c->card->token;
    if (f->kind == DALCS_FORMULA_CURRENT) {
        return c->card->letter == 'l' && is_name(f->signal[0], token) ? 1 : 0;
    }
    if (c->card->letter != 'c') {
        return 0;
    }
    return is_name(f->signal[0], &token[1]) && is_name(f->signal[1], &token[2])   ? 1
           : is_name(f->signal[0], &token[2]) && is_name(f->signal[1], &token[1]) ? -1
                                                                                   : 0;
}

static void refuse_signal(struct copying *c, const struct dalcs_formula *f) {
    const bool is_coil = c->card->letter == 'l';
    const char *name = c->card->token->text;
    const char *hint =
        is_coil ? dalcs_builder_hint(c->w->builder, "x and i(%s) are the current of the coil", name)
                : dalcs_builder_hint(c->w->builder,
                                     "x and v(%s,%s) are the voltage of the capacitor",
                                     c->card->token[1].text, c->card->token[2].text);
    dalcs_builder_error_at(c->w->builder, &f->where, hint,
                           is_coil ? "the flux of a coil depends on its own current alone"
                                   : "the charge of a capacitor depends on its own voltage alone");
    c->failed = true;
}

static const struct dalcs_formula *copy(struct copying *c, const struct dalcs_formula *f) {
    if (c->failed || c->copy[f->number_of] != NULL) {
        return c->failed ? NULL : c->copy[f->number_of];
    }
    const struct dalcs_formula *made = NULL;
    if (f->kind == DALCS_FORMULA_TIME) {
        made = c->argument;
    } else if (f->kind == DALCS_FORMULA_VOLTAGE || f->kind == DALCS_FORMULA_CURRENT) {
        const int direction = c->card != NULL ? direction_of(c, f) : 0;
        if (direction == 0) {
            refuse_signal(c, f);
            return NULL;
        }
        made = direction > 0 ? c->argument
                             : dalcs_formula_operation(c->w, DALCS_SUBTRACT,
                                                       dalcs_formula_number(c->w, 0), c->argument);
    } else {
        const struct dalcs_formula **argument = dalcs_arena_alloc(
            &c->w->builder->scratch, (size_t)f->n + 1, sizeof(const struct dalcs_formula *));
        for (int k = 0; argument != NULL && k < f->n; k++) {
            argument[k] = copy(c, f->argument[k]);
        }
        made = argument != NULL && !c->failed ? dalcs_formula_like(c->w, f, argument) : NULL;
    }
    if (made == NULL && !c->failed) {
        c->w->builder->out_of_memory = c->failed = true;
    }
    c->copy[f->number_of] = made;
    return made;
}

static const struct dalcs_formula *copy_with(struct dalcs_formula_writer *w,
                                             const struct dalcs_card *card,
                                             const struct dalcs_formula *f,
                                             const struct dalcs_formula *argument) {
    struct copying c = {.w = w, .argument = argument, .card = card};
    c.copy = dalcs_arena_alloc(&w->builder->scratch, (size_t)f->number_of + 1,
                               sizeof(const struct dalcs_formula *));
    if (c.copy == NULL || argument == NULL) {
        w->builder->out_of_memory = true;
        return NULL;
    }
    return copy(&c, f);
}

const struct dalcs_formula *dalcs_storage_function_write(struct dalcs_formula_writer *w,
                                                         const struct dalcs_storage_function *f,
                                                         const struct dalcs_formula *argument) {
    return copy_with(w, NULL, f->formula, argument);
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
    const struct dalcs_formula *own =
        copy_with(&w, NULL, formula, dalcs_formula_signal(&w, DALCS_FORMULA_CURRENT, element, NULL));
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
    *f = (struct dalcs_piecewise){slope->n, knot, slope->knot[0].left,
                                  slope->knot[slope->n - 1].right};
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
        sum = dalcs_formula_operation(w, DALCS_ADD, sum,
                                      times(w, knot->right - knot->left, beyond));
        sum = dalcs_formula_operation(
            w, DALCS_ADD, sum, times(w, bend / 2, dalcs_formula_call(w, "sqr", 1, &beyond)));
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
            dalcs_builder_error(builder, place, "a steep line is what can be",
                                "the %s jumps at a %s of %g %s", word->what, word->of, at,
                                word->unit);
            return false;
        }
        if (slope < 0) {
            dalcs_builder_error(builder, place, "it has to rise, or to stay where it is",
                                "the %s falls %s a %s of %g %s", word->what,
                                k < f->n ? "below" : "above", word->of, at, word->unit);
            return false;
        }
    }
    return true;
}

enum { DECADES = 9, PER_DECADE = 16 };

/* Nearer to 0 than this part of an ampere or a volt no circuit is: a law that falls there falls from 0 on. */
static const double NEAREST = 1e-8;

/* Where a law begins to fall from 0 on in one direction; 0: nowhere. It ends where it has no value. */
static double find_fall(const struct dalcs_builder *builder, const struct dalcs_storage_function *f,
                        double sign) {
    double before = raw_at(builder, f, 0);
    for (int k = -DECADES * PER_DECADE; k <= DECADES * PER_DECADE; k++) {
        const double x = sign * pow(10, (double)k / PER_DECADE);
        const double value = raw_at(builder, f, x);
        const double rise = sign * (value - before);
        if (!isfinite(value)) {
            return 0;
        }
        if (rise < -1e-12 * fmax(fabs(value), fabs(before))) {
            return x;
        }
        before = value;
    }
    return 0;
}

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
        const double fall = find_fall(builder, f, k == 0 ? 1 : -1);
        if (fall != 0 && fabs(fall) < NEAREST) {
            dalcs_builder_error(builder, place, "it has to rise", "the %s falls %s a %s of 0",
                                word->what, fall > 0 ? "above" : "below", word->of);
            return false;
        }
        if (fall != 0) {
            dalcs_builder_warn(builder, place,
                               "limit(x, low, high) in the place of x lets it stay where it is",
                               "the %s falls %s a %s of about %.2g %s: nothing has an answer there",
                               word->what, fall > 0 ? "above" : "below", word->of, fall,
                               word->unit);
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
    const struct dalcs_formula *f = copy_with(w, card, law->formula->formula, x);
    const double factor = !is_coil ? m : law->is_slope ? 1 / m : 1;
    return f != NULL && factor != 1 ? times(w, factor, f) : f;
}

/* What an inductance or a capacitance is the slope of. */
static bool integrate(struct dalcs_builder *builder, struct dalcs_formula_writer *w,
                      const struct dalcs_token *place, const struct wording *word,
                      struct dalcs_storage_function *f) {
    struct dalcs_piecewise slope;
    if (!find_lines(builder, w->element, f->formula, &slope)) {
        if (!builder->out_of_memory) {
            dalcs_builder_error(builder, place,
                                *word->unit == 'A'
                                    ? "write Flux=, the integral of the inductance"
                                    : "write Q=, the integral of the capacitance",
                                "only straight lines of the %s can be integrated", word->of);
        }
        return false;
    }
    const bool is_stepped = dalcs_piecewise_is_stepped(&slope);
    f->formula = is_stepped ? NULL : integrate_lines(w, &slope);
    const bool ok = is_stepped ? integrate_steps(&builder->scratch, &slope, &f->curve)
                               : f->formula != NULL;
    builder->out_of_memory = builder->out_of_memory || !ok;
    return ok;
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
        if (f->formula == NULL || (law->is_slope && !integrate(builder, &w, place, &word, f))) {
            return false;
        }
    }
    if (f->formula != NULL && find_lines(builder, card->token, f->formula, &f->curve)) {
        f->formula = NULL;
    }
    if (builder->out_of_memory || !(f->formula != NULL ? check_smooth(builder, place, &word, f)
                                                       : check_lines(builder, place, &word,
                                                                     &f->curve))) {
        return false;
    }
    f->unit = f->formula != NULL ? find_unit(builder, f) : unit_of_lines(&f->curve);
    f->at_0 = raw_at(builder, f, 0);
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
    *inverse = (struct dalcs_piecewise){n, knot, before > 0 ? f->unit / before : (double)INFINITY,
                                        after > 0 ? f->unit / after : (double)INFINITY};
    return true;
}
