/* explain_smooth.c - why Newton's method has found no values of smooth functions, in words. */
#include "session_internal.h"

#include "findings.h"
#include "smooth_newton.h"

#include <math.h>
#include <string.h>

/* "v(a)", "40", and "..." for what stands in the formula alone. */
static const char *name_argument(struct dalcs_session *s, const struct dalcs_system *system,
                                 const struct dalcs_smooth_input *of, int k) {
    const int column = of->column[k];
    if (column >= 0 && dalcs_names_is_inner(system->column[column].element)) {
        return "...";
    }
    const char *name = column >= 0
                           ? dalcs_arena_printf(&s->arena, "v(%s)", system->column[column].element)
                           : dalcs_arena_printf(&s->arena, "%.6g", of->number[k]);
    return name == NULL ? "" : name;
}

/* "b1" of "function2(b1)" */
static const char *name_owner(struct dalcs_session *s, const char *element) {
    const char *open = strchr(element, '(');
    const size_t n = strlen(element);
    char *owner = open != NULL && element[n - 1] == ')'
                      ? dalcs_arena_copy(&s->arena, open + 1, n - 2 - (size_t)(open - element))
                      : NULL;
    return owner != NULL ? owner : element;
}

/* Has the function no value there, or beyond, over the real numbers? What rounding takes across the end is held at it. */
static bool is_outside(enum dalcs_smooth_kind kind, double x, double exponent) {
    switch (kind) {
    case DALCS_SMOOTH_LOG:
    case DALCS_SMOOTH_LOG10:
        return !(x > 0);
    case DALCS_SMOOTH_SQRT:
        return x <= 0;
    case DALCS_SMOOTH_POWER:
        return x <= 0 && floor(exponent) != exponent;
    case DALCS_SMOOTH_ASIN:
    case DALCS_SMOOTH_ACOS:
        return fabs(x) >= 1;
    case DALCS_SMOOTH_ATANH:
        return !(fabs(x) < 1);
    case DALCS_SMOOTH_ACOSH:
        return x <= 1;
    default:
        return false;
    }
}

static const char *hint_of_smooth(enum dalcs_smooth_kind kind, double x, double exponent) {
    if (is_outside(kind, x, exponent)) {
        return "it has no value there, or beyond: limit(x, low, high), or a condition around it, "
               "keeps the "
               "argument where it has one";
    }
    if (kind == DALCS_SMOOTH_QUOTIENT) {
        return "the divisor may pass 0, or the circuit cannot give such a power: max(x, least) or "
               "a condition keeps the divisor away from 0";
    }
    return "there may be none, as of a power that the circuit cannot give; limit(x, low, high) "
           "bounds an argument, and a resistance what a source can do";
}

/* Where a function has no value on the way. */
static const char *pole_of(enum dalcs_smooth_kind kind) {
    switch (kind) {
    case DALCS_SMOOTH_QUOTIENT:
        return "the divisor passes 0";
    case DALCS_SMOOTH_TAN:
        return "the argument passes an odd multiple of pi/2";
    default:
        return "what has a negative exponent passes 0";
    }
}

void dalcs_explain_smooth(struct dalcs_session *s, const struct dalcs_component *c,
                          const char *when) {
    const struct dalcs_smooth_newton *newton = c->osnsp.smooth.newton;
    const struct dalcs_smooth_input *of = &c->system->smooth[newton->outcome.worst];
    if (newton->outcome.is_refused && c->osnsp.witness.n_elements > 0) {
        const struct dalcs_witness *w = &c->osnsp.witness;
        const char *names = dalcs_join_names(&s->arena, (size_t)w->n_elements, w->element);
        const char *hint = "a resistance in series limits a current, one across bounds a voltage";
        for (int k = 0; k < w->n_elements; k++) {
            hint = dalcs_is_initial(w->element[k]) ? dalcs_leave_initial : hint;
        }
        dalcs_diag_add(&s->diag, DALCS_ERROR, dalcs_place_of(&s->circuit, w->element[0]), hint,
                       "%s no solution was found: with the values that were tried of the products "
                       "and functions in formulas, the circuit around %s has none",
                       when, names == NULL ? "these elements" : names);
        return;
    }
    const char *name = dalcs_smooth_name(of->kind);
    const char *first = name_argument(s, c->system, of, 0);
    const char *second = of->n > 1 ? name_argument(s, c->system, of, 1) : "";
    const bool is_infix = *name == '*' || *name == '/';
    const char *text = is_infix ? dalcs_arena_printf(&s->arena, "%s %s %s", first, name, second)
                       : of->n > 1
                           ? dalcs_arena_printf(&s->arena, "%s(%s, %s)", name, first, second)
                           : dalcs_arena_printf(&s->arena, "%s(%s)", name, first);
    if (newton->outcome.at_pole) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, dalcs_place_of(&s->circuit, of->element),
                       "a condition keeps away from it, as in abs(x) > 1m ? 1/x : 0, or "
                       "limit(x, low, high) or max(x, least) bounds what divides",
                       "%s %s in '%s' has no value: %s", when, text == NULL ? "" : text,
                       name_owner(s, of->element), pole_of(of->kind));
        return;
    }
    const double *at = newton->x[newton->outcome.worst];
    const double x = at[of->column[0] >= 0 ? 0 : 1] + 0.0; /* no -0 */
    dalcs_diag_add(&s->diag, DALCS_ERROR, dalcs_place_of(&s->circuit, of->element),
                   hint_of_smooth(of->kind, x, at[1]),
                   "%s no solution was found: Newton's method finds no value of %s in '%s' that "
                   "agrees with the circuit; the last one tried was %.6g, for an argument of %.6g",
                   when, text == NULL ? "" : text, name_owner(s, of->element),
                   dalcs_smooth_newton_tried(newton, newton->outcome.worst), x);
}

bool dalcs_failed_at_pole(const struct dalcs_euler *e, enum dalcs_status status) {
    const struct dalcs_smooth_newton *newton =
        status > DALCS_OK && e->failure.system >= 0
            ? e->component[e->failure.system].osnsp.smooth.newton
            : NULL;
    return newton != NULL && newton->outcome.at_pole;
}
