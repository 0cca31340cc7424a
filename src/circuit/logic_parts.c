/* logic_parts.c - what becomes of a gate's outputs: sources, impedances, and what else follows them. */
#include "logic_parts.h"
#include "model_cards.h"
#include "output_resistance.h"

#include <math.h>
#include <string.h>

struct dalcs_logic_card *dalcs_logic_start(struct dalcs_builder *builder,
                                           const struct dalcs_token *name, int n_inputs) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_arena *arena = &circuit->arena;
    if (circuit->control.gate == NULL) {
        circuit->control.gate =
            dalcs_arena_alloc(arena, builder->logic.gate_capacity, sizeof *circuit->control.gate);
        circuit->control.comparator = dalcs_arena_alloc(arena, builder->logic.comparator_capacity,
                                                        sizeof *circuit->control.comparator);
    }
    struct dalcs_logic_card *of = dalcs_arena_alloc(&builder->scratch, 1, sizeof *of);
    struct dalcs_logic_pin *pin =
        dalcs_arena_alloc(&builder->scratch, (size_t)n_inputs, sizeof *pin);
    struct dalcs_logic_input *input = dalcs_arena_alloc(arena, (size_t)n_inputs, sizeof *input);
    const char *text = dalcs_arena_copy(arena, name->text, strlen(name->text));
    if (circuit->control.gate == NULL || circuit->control.comparator == NULL || of == NULL ||
        pin == NULL || input == NULL || text == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *of = (struct dalcs_logic_card){.name = name,
                                    .is_element = true,
                                    .gate = &circuit->control.gate[circuit->control.n_gates],
                                    .pin = pin,
                                    .node = {-1, -1}};
    *of->gate = (struct dalcs_logic_gate){.name = text,
                                          .n_inputs = n_inputs,
                                          .input = input,
                                          .output = {-1, -1},
                                          .sampled = -1,
                                          .where = dalcs_builder_keep_location(builder, name)};
    return of;
}

/* Of one point, which is all there is before a run. */
static int add_stimulus(struct dalcs_builder *builder, double value) {
    struct dalcs_circuit *circuit = builder->circuit;
    double *point = dalcs_arena_alloc(&circuit->arena, 2, sizeof *point);
    if (point == NULL) {
        builder->out_of_memory = true;
        return -1;
    }
    point[1] = value;
    circuit->stimulus[circuit->n_stimuli] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_PWL,
                                .is_written = true,
                                .u.pwl = {.n = 1, .t = point, .v = point + 1}};
    return circuit->n_stimuli++;
}

/* Across the larger resistance while the output is at the level that has the smaller one: half way between both it
 * changes over. */
static bool add_other_resistance(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                                 const char *what, const struct dalcs_device *r, int common) {
    struct dalcs_device *s = dalcs_builder_add_inner_device(builder, DALCS_SWITCH, what, of->name);
    const bool is_when_high = of->ohms[1] < of->ohms[0];
    const double small = fmin(of->ohms[0], of->ohms[1]);
    const double middle = 0.5 * (of->gate->low + of->gate->high);
    const struct dalcs_switch_model model = {.name = "rout",
                                             .ron = small * r->value / (r->value - small),
                                             .roff = (double)INFINITY,
                                             .vt = is_when_high ? middle : -middle};
    const int index = dalcs_switch_add_model(builder, &model);
    if (s == NULL || index < 0) {
        return false;
    }
    s->node[0] = r->node[0];
    s->node[1] = r->node[1];
    s->node[is_when_high ? 2 : 3] = r->node[0];
    s->node[is_when_high ? 3 : 2] = common;
    s->model = index;
    return true;
}

static bool add_capacitance(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                            const char *what, const int *node, double first) {
    struct dalcs_device *c =
        dalcs_builder_add_inner_device(builder, DALCS_CAPACITOR, what, of->name);
    if (c == NULL) {
        return false;
    }
    c->node[0] = node[0];
    c->node[1] = node[1];
    c->value = of->farad;
    c->initial = first;
    c->has_initial = true;
    return true;
}

/* Puts what it has between a source of an output, from `first` volts on, and its pin. */
static bool add_impedance(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                          const char *what, struct dalcs_device *source, double first) {
    const int pin[2] = {source->node[0], source->node[1]};
    if (!(of->ohms[0] > 0) && !(of->ohms[1] > 0)) {
        if (of->may_resist) {
            dalcs_output_add(builder, of->name, source);
        }
        return true;
    }
    struct dalcs_device *r =
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, what, of->name);
    const int node = dalcs_builder_inner_node(builder, what, of->name);
    if (r == NULL || node < 0) {
        return false;
    }
    r->node[0] = node;
    r->node[1] = pin[0];
    r->value = fmax(of->ohms[0], of->ohms[1]);
    source->node[0] = node;
    return (of->ohms[0] == of->ohms[1] || add_other_resistance(builder, of, what, r, pin[1])) &&
           (of->farad == 0 || add_capacitance(builder, of, what, pin, first));
}

static struct dalcs_device *add_source(struct dalcs_builder *builder,
                                       const struct dalcs_logic_card *of, bool is_first,
                                       const char *what) {
    return is_first && of->is_element
               ? dalcs_builder_add_device(builder, DALCS_VSOURCE, of->name)
               : dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, what, of->name);
}

/* A source from the k-th output pin to the common one, whose stimulus is the gate's. */
static bool add_output(struct dalcs_builder *builder, const struct dalcs_logic_card *of, int k,
                       struct dalcs_device *source) {
    const int stimulus = add_stimulus(builder, k == 0 ? of->gate->low : of->gate->high);
    if (source == NULL || stimulus < 0) {
        return false;
    }
    source->node[0] = of->node[k];
    source->node[1] = of->common;
    source->stimulus = of->gate->output[k] = stimulus;
    const bool is_high = of->gate->initial == (k == 0);
    return add_impedance(builder, of, k == 0 ? "rout" : "routbar", source,
                         is_high ? of->gate->high : of->gate->low);
}

/* One of both that a sample shows: a wire while the mode is on, or off. */
static bool add_choice(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                       const char *what, const int *node, int mode, bool is_on) {
    struct dalcs_device *s = dalcs_builder_add_inner_device(builder, DALCS_SWITCH, what, of->name);
    const struct dalcs_switch_model model = {
        .name = "choice", .roff = (double)INFINITY, .vt = is_on ? 0.5 : -0.5};
    const int index = dalcs_switch_add_model(builder, &model);
    if (s == NULL || index < 0) {
        return false;
    }
    s->node[0] = node[0];
    s->node[1] = node[1];
    s->node[is_on ? 2 : 3] = mode;
    s->model = index;
    return true;
}

/* What is held behind one switch and the input behind another, and a source of what both lead to. */
static struct dalcs_device *add_tracking(struct dalcs_builder *builder,
                                         const struct dalcs_logic_card *of,
                                         struct dalcs_device *hold) {
    static const char *const names[] = {"hold", "track", "mode", "either"};
    int node[4];
    for (int k = 0; k < 4; k++) {
        node[k] = dalcs_builder_inner_node(builder, names[k], of->name);
    }
    struct dalcs_device *track =
        dalcs_builder_add_inner_device(builder, DALCS_VCVS, "track", of->name);
    struct dalcs_device *mode =
        dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, "mode", of->name);
    struct dalcs_device *out = dalcs_builder_add_device(builder, DALCS_VCVS, of->name);
    if (builder->out_of_memory || track == NULL || mode == NULL || out == NULL ||
        !add_choice(builder, of, "held", (int[]){node[0], node[3]}, node[2], false) ||
        !add_choice(builder, of, "tracked", (int[]){node[1], node[3]}, node[2], true)) {
        return NULL;
    }
    hold->node[0] = node[0];
    track->node[0] = node[1];
    track->node[2] = of->sampled.node;
    track->node[3] = of->sampled.reference;
    mode->node[0] = node[2];
    mode->stimulus = of->gate->output[1] = add_stimulus(builder, 0);
    out->node[2] = node[3];
    track->value = out->value = 1;
    return out;
}

static bool add_sample(struct dalcs_builder *builder, const struct dalcs_logic_card *of) {
    const bool tracks = of->pin[DALCS_GATE_PRESET].is_wired;
    struct dalcs_device *hold = add_source(builder, of, !tracks, "hold");
    const int stimulus = add_stimulus(builder, of->gate->held);
    if (hold == NULL || stimulus < 0) {
        return false;
    }
    hold->stimulus = of->gate->output[0] = stimulus;
    of->gate->device = (int)(hold - builder->circuit->device);
    struct dalcs_device *out = tracks ? add_tracking(builder, of, hold) : hold;
    if (out == NULL) {
        return false;
    }
    out->node[0] = of->node[0];
    out->node[1] = of->common;
    return add_impedance(builder, of, "rout", out, of->gate->held);
}

static bool add_outputs(struct dalcs_builder *builder, const struct dalcs_logic_card *of) {
    if (of->gate->kind == DALCS_GATE_SAMPLE) {
        return add_sample(builder, of);
    }
    const int first = of->node[0] >= 0 ? 0 : 1;
    struct dalcs_device *source = add_source(builder, of, true, "q");
    if (source == NULL || !add_output(builder, of, first, source)) {
        return false;
    }
    of->gate->device = (int)(source - builder->circuit->device);
    return first == 1 || of->node[1] < 0 ||
           add_output(builder, of, 1, add_source(builder, of, false, "qbar"));
}

void dalcs_logic_add(struct dalcs_builder *builder, struct dalcs_logic_card *of) {
    if (add_outputs(builder, of)) {
        builder->circuit->control.n_gates++;
        of->before = builder->logic.gate_card;
        builder->logic.gate_card = of;
    }
}
