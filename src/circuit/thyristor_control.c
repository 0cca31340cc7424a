/* thyristor_control.c - the formula of the control of a thyristor's switch; thyristor.c says which. */
#include "formula_writer.h"
#include "thyristor.h"

/* factor x + offset, in [low, high] */
static const struct dalcs_formula *cut(struct dalcs_formula_writer *w, double factor,
                                       const struct dalcs_formula *x, double offset, double low,
                                       double high) {
    const struct dalcs_formula *line =
        dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, factor), x);
    line = dalcs_formula_operation(w, DALCS_ADD, line, dalcs_formula_number(w, offset));
    return dalcs_formula_call(w, "limit", 3,
                              (const struct dalcs_formula *const[]){line,
                                                                    dalcs_formula_number(w, low),
                                                                    dalcs_formula_number(w, high)});
}

static const struct dalcs_formula *control(struct dalcs_formula_writer *w,
                                           const struct dalcs_thyristor *t,
                                           const struct dalcs_thyristor_places *p) {
    const struct dalcs_formula *v =
        dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE, p->gate, p->reference);
    if (t->kind == DALCS_TRIAC) {
        v = dalcs_formula_call(w, "abs", 1, &v);
    }
    const bool holds = t->holding > 0;
    const struct dalcs_formula *i = dalcs_formula_signal(w, DALCS_FORMULA_CURRENT, p->self, NULL);
    const struct dalcs_formula *u =
        dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE, p->anode, p->cathode);
    if (t->kind == DALCS_TRIAC && !holds) {
        const struct dalcs_formula *above =
            dalcs_formula_operation(w, DALCS_SUBTRACT, v, dalcs_formula_number(w, t->trigger));
        const struct dalcs_formula *gate = dalcs_formula_operation(
            w, DALCS_MULTIPLY, dalcs_formula_number(w, 4), dalcs_formula_call(w, "u", 1, &above));
        const struct dalcs_formula *both =
            dalcs_formula_operation(w, DALCS_ADD, gate, cut(w, 0.5 / t->reversed, u, 0, -1, 0));
        return t->drop >= t->reversed
                   ? both
                   : dalcs_formula_operation(w, DALCS_ADD, both,
                                             cut(w, 0.5 * p->direction / t->other, i, 0, -1, 0));
    }
    const struct dalcs_formula *sum =
        cut(w, (holds ? 2.5 : 1.5) / t->trigger, v, 0, 0, holds ? 3 : 2);
    if (holds && t->latching == 0) {
        sum = dalcs_formula_operation(w, DALCS_ADD, sum,
                                      cut(w, p->direction / t->holding, i, -1.5, -1, 0));
    }
    if (t->kind == DALCS_GTO) {
        sum = dalcs_formula_operation(w, DALCS_ADD, sum, cut(w, 0.5 / t->turn_off, v, 0, -3, 0));
    }
    return sum;
}

const struct dalcs_token *dalcs_thyristor_control(struct dalcs_builder *builder,
                                                  const struct dalcs_thyristor *thyristor,
                                                  const struct dalcs_thyristor_places *places) {
    struct dalcs_formula_writer w;
    if (!dalcs_formula_writer_start(&w, builder, places->self)) {
        builder->out_of_memory = true;
        return NULL;
    }
    return dalcs_formula_token(&w, control(&w, thyristor, places));
}
