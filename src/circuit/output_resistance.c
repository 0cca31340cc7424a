/* output_resistance.c - outputs of LTspice's A devices that other elements hold.
 *
 * LTspice has 1 ohm in each. An ideal output is the limit of no resistance, which exists only where nothing without a
 * resistance closes a loop with it: another output on its node, a source, an ideal diode, a voltage of .ic. There it is no
 * limit, and the output has LTspice's resistance. Elements without resistance join nodes to parts (union and find); outputs
 * are branches between parts. A branch that is alone at one of its parts is on no loop; without it the next one may be alone. */
#include "output_resistance.h"

#include "union_find.h"

static const double usual = 1; /* ohm */

void dalcs_output_add(struct dalcs_builder *builder, const struct dalcs_token *element,
                      const struct dalcs_device *source) {
    struct dalcs_output *output = dalcs_arena_alloc(&builder->scratch, 1, sizeof *output);
    if (dalcs_builder_note_memory(builder, output != NULL)) {
        *output = (struct dalcs_output){builder->logic.output, element,
                                        (int)(source - builder->circuit->device)};
        builder->logic.output = output;
    }
}

static bool has_no_resistance(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    switch (d->kind) {
    case DALCS_VSOURCE:
    case DALCS_VCVS:
    case DALCS_CCVS:
        return true;
    case DALCS_RESISTOR:
        return d->value == 0;
    case DALCS_DIODE:
        return d->model >= 0 && c->models.of_diode[d->model].ron == 0;
    default:
        return d->kind == DALCS_SWITCH && d->model >= 0 && c->models.of_switch[d->model].ron == 0;
    }
}

/* Nodes that elements without resistance join, but outputs, which is_output marks. */
static void join(const struct dalcs_builder *builder, const bool *is_output, int *part) {
    const struct dalcs_circuit *c = builder->circuit;
    dalcs_union_reset(part, c->n_nodes);
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        if (!is_output[k] && has_no_resistance(c, d)) {
            dalcs_union_join(part, d->node[0], d->node[1]);
        }
    }
    const bool holds = !c->analyses.transient.use_initial_conditions;
    for (size_t k = 0; k < builder->analyses.n_initial_conditions && holds; k++) {
        const struct dalcs_initial_condition *ic = &builder->analyses.initial_condition[k];
        dalcs_union_join(part, ic->node[0], ic->node[1]);
    }
}

static void part_ends(const struct dalcs_builder *builder, const struct dalcs_output *output,
                      int *part, int *end) {
    const int *node = builder->circuit->device[output->device].node;
    end[0] = dalcs_union_find(part, node[0]);
    end[1] = dalcs_union_find(part, node[1]);
}

/* Those that are on no loop are no longer marked. */
static void leave_free(const struct dalcs_builder *builder, bool *is_output, int *part,
                       int *n_at_part) {
    int end[2];
    const struct dalcs_output *o;
    for (o = builder->logic.output; o != NULL; o = o->before) {
        part_ends(builder, o, part, end);
        n_at_part[end[0]]++;
        n_at_part[end[1]]++;
    }
    bool goes_on = true;
    while (goes_on) {
        goes_on = false;
        for (o = builder->logic.output; o != NULL; o = o->before) {
            part_ends(builder, o, part, end);
            if (is_output[o->device] && (n_at_part[end[0]] == 1 || n_at_part[end[1]] == 1)) {
                is_output[o->device] = false;
                n_at_part[end[0]]--;
                n_at_part[end[1]]--;
                goes_on = true;
            }
        }
    }
}

static void add_resistance(struct dalcs_builder *builder, const struct dalcs_output *output) {
    const bool is_second = output->before != NULL && output->before->element == output->element;
    const char *what = is_second ? "routbar" : "rout";
    const int node = dalcs_builder_inner_node(builder, what, output->element);
    struct dalcs_device *r =
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, what, output->element);
    if (node < 0 || r == NULL) {
        return;
    }
    struct dalcs_device *source = &builder->circuit->device[output->device];
    r->node[0] = node;
    r->node[1] = source->node[0];
    r->value = usual;
    source->node[0] = node;
    dalcs_builder_note(builder, output->element, "Rout= of a gate or a sample chooses another",
                       "an output of '%s' is held by other elements: it has LTspice's resistance "
                       "of 1 ohm",
                       output->element->text);
}

void dalcs_output_resolve(struct dalcs_builder *builder) {
    const struct dalcs_circuit *c = builder->circuit;
    if (builder->logic.output == NULL || builder->failed) {
        return;
    }
    int *part = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_nodes, sizeof *part);
    int *n_at_part = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_nodes, sizeof *n_at_part);
    bool *is_output = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_devices, sizeof *is_output);
    if (!dalcs_builder_note_memory(builder,
                                   part != NULL && n_at_part != NULL && is_output != NULL)) {
        return;
    }
    size_t n = 0;
    for (const struct dalcs_output *o = builder->logic.output; o != NULL; o = o->before) {
        is_output[o->device] = true;
        n++;
    }
    join(builder, is_output, part);
    leave_free(builder, is_output, part, n_at_part);
    if (!dalcs_builder_reserve_devices(builder, n)) {
        return;
    }
    for (const struct dalcs_output *o = builder->logic.output; o != NULL; o = o->before) {
        if (is_output[o->device]) {
            add_resistance(builder, o);
        }
    }
}
