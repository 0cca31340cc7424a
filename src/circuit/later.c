/* later.c - delayed sources: a V source of a signal's history, in series with an E source that has no gain but where
 * everything rests: there what is delayed is what it is now. */
#include "later.h"

#include "history.h"
#include "result_cards.h"

#include <string.h>

struct dalcs_later_list {
    const struct dalcs_later_list *before;
    struct dalcs_later item;
};

void dalcs_later_add(struct dalcs_builder *builder, const struct dalcs_later *later) {
    struct dalcs_later_list *list = dalcs_arena_alloc(&builder->scratch, 1, sizeof *list);
    if (list == NULL) {
        builder->out_of_memory = true;
        return;
    }
    *list = (struct dalcs_later_list){.before = builder->formulas.later, .item = *later};
    builder->formulas.later = list;
}

size_t dalcs_later_pending(const struct dalcs_builder *builder) {
    size_t n = 0;
    for (const struct dalcs_later_list *l = builder->formulas.later; l != NULL; l = l->before) {
        n++;
    }
    return n;
}

static struct dalcs_history *make_history(struct dalcs_builder *builder, double seconds) {
    struct dalcs_history *history = dalcs_arena_alloc(&builder->circuit->arena, 1, sizeof *history);
    if (history == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *history = (struct dalcs_history){.delay = seconds};
    return history;
}

static void add_one(struct dalcs_builder *builder, const struct dalcs_later *later) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_history *history = make_history(builder, later->seconds);
    const int middle = dalcs_builder_inner_node(builder, later->what, later->name);
    const char *rest_name = dalcs_builder_hint(builder, "rest_%s", later->what);
    const char *element =
        dalcs_arena_copy(&circuit->arena, later->name->text, strlen(later->name->text));
    const char *name =
        dalcs_arena_printf(&circuit->arena, "%s(%s)", later->what, later->name->text);
    struct dalcs_device *v =
        dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, later->what, later->name);
    struct dalcs_device *rest =
        rest_name != NULL
            ? dalcs_builder_add_inner_device(builder, DALCS_VCVS, rest_name, later->name)
            : NULL;
    if (history == NULL || middle < 0 || element == NULL || name == NULL || v == NULL ||
        rest == NULL) {
        builder->out_of_memory = true;
        return;
    }
    v->node[0] = later->output[0];
    v->node[1] = rest->node[0] = middle;
    rest->node[1] = later->output[1];
    rest->node[2] = later->input;
    rest->is_delay = true;
    v->stimulus = circuit->n_stimuli++;
    circuit->stimulus[v->stimulus] = (struct dalcs_stimulus){
        .kind = DALCS_STIMULUS_DELAYED, .has_dc = true, .is_written = true, .u.history = history};
    struct dalcs_signal signal = {
        .name = name, .kind = DALCS_SIGNAL_VOLTAGE, .device = -1, .node = {later->input, 0}};
    circuit->control.delayed[circuit->control.n_delayed++] =
        (struct dalcs_delayed){.name = element,
                               .signal = dalcs_signals_measure(builder, signal),
                               .initial = later->initial,
                               .history = history};
}

void dalcs_later_resolve(struct dalcs_builder *builder) {
    const size_t n = dalcs_later_pending(builder);
    struct dalcs_circuit *circuit = builder->circuit;
    if (n == 0) {
        return;
    }
    circuit->control.delayed =
        dalcs_arena_alloc(&circuit->arena, n, sizeof *circuit->control.delayed);
    builder->out_of_memory = builder->out_of_memory || circuit->control.delayed == NULL ||
                             !dalcs_builder_reserve_devices(builder, n * DALCS_LATER_DEVICES);
    for (const struct dalcs_later_list *l = builder->formulas.later;
         l != NULL && !builder->out_of_memory; l = l->before) {
        add_one(builder, &l->item);
    }
}
