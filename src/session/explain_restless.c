/* explain_restless.c - a switch that no position suits, in words. */
#include "explain.h"

#include "quantity.h"
#include "refusal.h"

#include <string.h>

/* What controls a switch, as a signal: "v(a)", "v(a,b)", "i(v2)". */
static const char *name_control(struct dalcs_session *s, const struct dalcs_device *d) {
    const struct dalcs_circuit *c = &s->circuit;
    const char *name = NULL;
    if (d->control >= 0) {
        name = dalcs_arena_printf(&s->arena, "i(%s)", c->device[d->control].name);
    } else if (d->node[3] == 0) {
        name = dalcs_arena_printf(&s->arena, "v(%s)", c->node_name[d->node[2]]);
    } else {
        name = dalcs_arena_printf(&s->arena, "v(%s,%s)", c->node_name[d->node[2]],
                                  c->node_name[d->node[3]]);
    }
    return name == NULL ? "" : name;
}

void dalcs_explain_restless(struct dalcs_session *s, const struct dalcs_component *c,
                            const char *when) {
    const struct dalcs_restless *found = &c->failure.restless;
    const struct dalcs_pair *pair = &c->system->pair[found->pair];
    const struct dalcs_device *d = NULL;
    for (int i = 0; i < s->circuit.n_devices && d == NULL; i++) {
        const struct dalcs_device *one = &s->circuit.device[i];
        d = one->kind == DALCS_SWITCH && strcmp(one->name, pair->element) == 0 ? one : NULL;
    }
    const bool is_current = d != NULL && d->control >= 0;
    const bool is_inverted = d != NULL && s->circuit.models.of_switch[d->model].is_inverted;
    const double sign = is_inverted ? -1.0 : 1.0;
    const double value[] = {found->closed, pair->turn_off, found->open, pair->turn_on};
    char text[4][DALCS_QUANTITY_SIZE];
    for (int k = 0; k < 4; k++) {
        dalcs_quantity_write(text[k], sign * value[k], is_current ? "A" : "V", 6);
    }
    const char *hint =
        dalcs_pair_remembers(pair)
            ? "what it does acts on its control at once: a capacitor at the control, a coil or a "
              "delay between them decides, and without a hysteresis it may slide"
            : "what it does acts on its control at once: a capacitor at the control, a coil or a "
              "delay between them decides; where it may slide, method=auto does so";
    dalcs_diag_add(&s->diag, DALCS_ERROR, dalcs_place_of(&s->circuit, pair->element), hint,
                   "%s no position of '%s' agrees with its control, %s: where it is closed that is "
                   "%s, and %s %s opens it; where it is open that is %s, and %s %s closes it",
                   when, pair->element, d == NULL ? "what it reads" : name_control(s, d), text[0],
                   is_inverted ? "above" : "below", text[1], text[2],
                   is_inverted ? "below" : "above", text[3]);
}
