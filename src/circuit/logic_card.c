/* logic_card.c - LTspice's gates and flip-flops.
 *
 *     Aname in1 in2 in3 in4 in5 qbar q com FUNCTION [Vhigh=1 Vlow=0 Ref=middle Td=0 Trise=0 Tfall=Trise Vt=0 Vh=0 ...]
 *
 * A pin that is tied to com is not there. An input that another such element's output drives reads its bit; any other is
 * a comparator: a switch that nothing flows in, from an inner node with a resistor to ground, so that its control, its
 * threshold and its events are those of all switches. Elements that read the same against the same threshold have one
 * comparator, for their inputs change together. */
#include "builder.h"

#include <math.h>
#include <string.h>

static const char USAGE[] =
    "a gate is: Aname in1 in2 in3 in4 in5 qbar q com FUNCTION [Vhigh=volts Vlow=volts Ref=volts "
    "Td=seconds Trise=seconds Tfall=seconds], pins that are not used tied to com";

enum { PIN_INVERTED = 5, PIN_OUTPUT, PIN_COMMON, N_PINS };

enum { VHIGH, VLOW, REF, TD, TRISE, TFALL, VT, VH, ROUT, IC, N_PARAMETERS };

/* A card, until the outputs of all are known. */
struct dalcs_logic_card {
    const struct dalcs_logic_card *before;
    const struct dalcs_card *card;
    struct dalcs_logic_gate *gate;
    int node[N_PINS];
    bool is_schmitt;
    bool is_exact;  /* outputs jump from one level to the other, with no resistance */
    double on, off; /* V: where an input rises and falls */
};

/* ---- The card ----------------------------------------------------------------------------------------- */

static bool find_kind(struct dalcs_builder *builder, const struct dalcs_token *word,
                      struct dalcs_logic_card *of) {
    static const struct {
        const char *name;
        enum dalcs_logic_kind kind;
    } kinds[] = {{"and", DALCS_GATE_AND},
                 {"or", DALCS_GATE_OR},
                 {"xor", DALCS_GATE_XOR},
                 {"srflop", DALCS_GATE_LATCH},
                 {"dflop", DALCS_GATE_FLIP_FLOP}};

    of->gate->kind = DALCS_GATE_BUFFER;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        if (strcmp(word->text, kinds[k].name) == 0) {
            of->gate->kind = kinds[k].kind;
        }
    }
    of->is_schmitt = strstr(word->text, "schm") != NULL;
    if (strstr(word->text, "inv") != NULL && of->node[PIN_OUTPUT] != of->node[PIN_COMMON]) {
        dalcs_builder_error(builder, word,
                            "wire the sixth pin, the complement, and tie the seventh to com",
                            "the output of an inverter is its pin qbar");
        return false;
    }
    return true;
}

static bool read_parameters(struct dalcs_reader *reader, struct dalcs_parameter *p) {
    static const char *const without_effect[] = {"tripdt", "ttol", "temp"};
    struct dalcs_builder *builder = reader->builder;
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *name = dalcs_reader_take_parameter(reader);
        if (name == NULL) {
            dalcs_reader_unexpected(reader);
            return false;
        }
        int k = 0;
        while (k < N_PARAMETERS && strcmp(name->text, p[k].name) != 0) {
            k++;
        }
        if (k == N_PARAMETERS) {
            if (dalcs_builder_is_one_of(name->text, without_effect, 3)) {
                if (!dalcs_reader_skip_value(reader)) {
                    return false;
                }
                continue;
            }
            dalcs_builder_error(builder, name, USAGE, "a gate has no parameter '%s' here",
                                name->text);
            return false;
        }
        p[k].place = name;
        if (!dalcs_reader_number(reader, p[k].quantity, "a value", &p[k].value)) {
            return false;
        }
    }
    return true;
}

static bool check_parameters(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    static const int not_negative[] = {TD, TRISE, TFALL, VH, ROUT};
    for (size_t k = 0; k < sizeof not_negative / sizeof not_negative[0]; k++) {
        const struct dalcs_parameter *one = &p[not_negative[k]];
        if (one->value < 0) {
            dalcs_builder_error(builder, one->place, USAGE, "'%s' cannot be negative", one->name);
            return false;
        }
    }
    if (!(p[VHIGH].value > p[VLOW].value)) {
        dalcs_builder_error(builder, p[VHIGH].place != NULL ? p[VHIGH].place : p[VLOW].place,
                            "exchange the two, and use the other output",
                            "Vhigh must be above Vlow");
        return false;
    }
    return true;
}

static void take_parameters(struct dalcs_logic_card *of, const struct dalcs_parameter *p) {
    struct dalcs_logic_gate *g = of->gate;
    g->low = p[VLOW].value;
    g->high = p[VHIGH].value;
    g->delay = p[TD].value;
    g->rise = p[TRISE].value;
    g->fall = p[TFALL].place != NULL ? p[TFALL].value : p[TRISE].value;
    g->initial = p[IC].value > 0.5 * (g->low + g->high);
    of->is_exact = g->rise == 0 && g->fall == 0 && p[ROUT].value == 0;
    const double ref = p[REF].place != NULL ? p[REF].value : g->low + 0.5 * (g->high - g->low);
    of->on = of->is_schmitt ? p[VT].value + p[VH].value : ref;
    of->off = of->is_schmitt ? p[VT].value - p[VH].value : ref;
}

/* ---- What becomes of it ---------------------------------------------------------------------------------- */

/* A source from the k-th output pin to com, whose stimulus is the gate's. */
static bool add_output(struct dalcs_builder *builder, const struct dalcs_logic_card *of, int k,
                       struct dalcs_device *source, double ohms) {
    struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_token *name = of->card->token;
    const int pin = of->node[k == 0 ? PIN_OUTPUT : PIN_INVERTED];
    double *point = dalcs_arena_alloc(&circuit->arena, 2, sizeof *point);
    if (source == NULL || point == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    point[0] = 0;
    point[1] = k == 0 ? of->gate->low : of->gate->high;
    source->node[0] = pin;
    source->node[1] = of->node[PIN_COMMON];
    source->stimulus = of->gate->output[k] = circuit->n_stimuli;
    circuit->stimulus[circuit->n_stimuli++] = (struct dalcs_stimulus){
        .kind = DALCS_STIMULUS_PWL, .u.pwl = {.n = 1, .t = point, .v = point + 1}};
    if (ohms > 0) {
        const char *what = k == 0 ? "rout" : "routbar";
        struct dalcs_device *r =
            dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, what, name);
        const int node = dalcs_builder_inner_node(builder, what, name);
        if (r == NULL || node < 0) {
            return false;
        }
        r->node[0] = node;
        r->node[1] = pin;
        r->value = ohms;
        source->node[0] = node;
    }
    return true;
}

static bool add_outputs(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                        double ohms) {
    const struct dalcs_token *name = of->card->token;
    const int common = of->node[PIN_COMMON];
    bool has[2] = {of->node[PIN_OUTPUT] != common, of->node[PIN_INVERTED] != common};
    if (!has[0] && !has[1]) {
        dalcs_builder_error(builder, name, USAGE, "no output of '%s' is wired", name->text);
        return false;
    }
    struct dalcs_device *first = dalcs_builder_add_device(builder, DALCS_VSOURCE, name);
    if (first == NULL || !add_output(builder, of, has[0] ? 0 : 1, first, ohms)) {
        return false;
    }
    return !(has[0] && has[1]) ||
           add_output(builder, of, 1,
                      dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, "qbar", name), ohms);
}

static struct dalcs_logic_card *start(struct dalcs_builder *builder,
                                      const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    const size_t most = builder->gate_capacity;
    if (circuit->gate == NULL) {
        circuit->gate = dalcs_arena_alloc(&circuit->arena, most, sizeof *circuit->gate);
        circuit->comparator = dalcs_arena_alloc(&circuit->arena, DALCS_GATE_INPUTS * most,
                                                sizeof *circuit->comparator);
    }
    struct dalcs_logic_card *of = dalcs_arena_alloc(&builder->scratch, 1, sizeof *of);
    const char *name =
        dalcs_arena_copy(&circuit->arena, card->token->text, strlen(card->token->text));
    if (circuit->gate == NULL || circuit->comparator == NULL || of == NULL || name == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    of->card = card;
    of->gate = &circuit->gate[circuit->n_gates];
    *of->gate =
        (struct dalcs_logic_gate){.name = name,
                                  .output = {-1, -1},
                                  .where = dalcs_builder_keep_location(builder, card->token)};
    return of;
}

void dalcs_logic_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_logic_card *of = start(builder, card);
    struct dalcs_parameter p[N_PARAMETERS] = {
        [VHIGH] = {"vhigh", DALCS_VOLTAGE, false, 1, NULL},
        [VLOW] = {"vlow", DALCS_VOLTAGE, false, 0, NULL},
        [REF] = {"ref", DALCS_VOLTAGE, false, 0, NULL},
        [TD] = {"td", DALCS_SECOND, false, 0, NULL},
        [TRISE] = {"trise", DALCS_SECOND, false, 0, NULL},
        [TFALL] = {"tfall", DALCS_SECOND, false, 0, NULL},
        [VT] = {"vt", DALCS_VOLTAGE, false, 0, NULL},
        [VH] = {"vh", DALCS_VOLTAGE, false, 0, NULL},
        [ROUT] = {"rout", DALCS_OHM, false, 0, NULL},
        [IC] = {"ic", DALCS_VOLTAGE, false, 0, NULL},
    };
    if (of == NULL || !dalcs_reader_nodes(&reader, N_PINS, of->node)) {
        return;
    }
    reader.at++; /* the function */
    if (!find_kind(builder, &card->token[DALCS_LOGIC_MODEL], of) || !read_parameters(&reader, p) ||
        !check_parameters(builder, p)) {
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    if (p[IC].place == NULL) {
        p[IC].value = p[VLOW].value;
    }
    take_parameters(of, p);
    if (add_outputs(builder, of, p[ROUT].value)) {
        builder->circuit->n_gates++;
        of->before = builder->gate_card;
        builder->gate_card = of;
    }
}

/* ---- What inputs read ------------------------------------------------------------------------------------- */

/* The place among comparators of a switch that closes there; -1: out of memory. */
static int find_comparator(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                           int pin, const int *control) {
    static const char *const names[] = {"in1", "in2", "in3", "in4", "in5"};
    struct dalcs_circuit *circuit = builder->circuit;
    const double vt = 0.5 * (of->on + of->off);
    const double vh = 0.5 * (of->on - of->off);
    for (int k = 0; k < circuit->n_comparators; k++) {
        const struct dalcs_device *s = &circuit->device[circuit->comparator[k]];
        const struct dalcs_switch_model *m = &circuit->switch_model[s->model];
        if (s->node[2] == control[0] && s->node[3] == control[1] && m->vt == vt && m->vh == vh) {
            return k;
        }
    }
    const struct dalcs_token *name = of->card->token;
    struct dalcs_device *s =
        dalcs_builder_add_inner_device(builder, DALCS_SWITCH, names[pin], name);
    struct dalcs_device *r =
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, names[pin], name);
    const int node = dalcs_builder_inner_node(builder, names[pin], name);
    const struct dalcs_switch_model model = {
        .name = "comparator", .ron = 1, .roff = (double)INFINITY, .vt = vt, .vh = vh};
    const int index = dalcs_switch_add_model(builder, &model);
    if (s == NULL || r == NULL || node < 0 || index < 0) {
        return -1;
    }
    s->node[0] = r->node[0] = node;
    s->node[1] = r->node[1] = 0;
    s->node[2] = control[0];
    s->node[3] = control[1];
    s->model = index;
    r->value = 1;
    circuit->comparator[circuit->n_comparators] = (int)(s - circuit->device);
    return circuit->n_comparators++;
}

/* A gate that drives a node: twice its number, and one more where by its complement; -1: none, or not as this input
 * reads it: against another node, in the course of a ramp, or on one side of the threshold alone. */
static int driver_of(const struct dalcs_builder *builder,
                     const struct dalcs_logic_card *const *driver,
                     const struct dalcs_logic_card *of, const int *control) {
    const struct dalcs_logic_card *by = driver[control[0]];
    if (by == NULL || !by->is_exact || by->node[PIN_COMMON] != control[1] ||
        by->gate->low >= of->off || by->gate->high <= of->on) {
        return -1;
    }
    return 2 * (int)(by->gate - builder->circuit->gate) + (by->node[PIN_OUTPUT] != control[0]);
}

static void resolve_input(struct dalcs_builder *builder,
                          const struct dalcs_logic_card *const *driver,
                          const struct dalcs_logic_card *of, int pin) {
    const int common = of->node[PIN_COMMON];
    struct dalcs_logic_input *input = &of->gate->input[pin];
    const int control[2] = {of->node[pin], of->is_schmitt ? of->node[1] : common};
    if (of->node[pin] == common && !(of->is_schmitt && control[1] != common)) {
        return;
    }
    const int by = driver_of(builder, driver, of, control);
    if (by >= 0) {
        builder->read_by_gates[control[0]] = true;
        *input = (struct dalcs_logic_input){DALCS_GATE_GATE, by / 2, by % 2 != 0};
        return;
    }
    const int index = find_comparator(builder, of, pin, control);
    if (index >= 0) {
        *input = (struct dalcs_logic_input){DALCS_GATE_COMPARATOR, index, false};
    }
}

/* Pins that mean nothing for this function, and inputs that it must have. */
static bool check_inputs(struct dalcs_builder *builder, const struct dalcs_logic_card *of) {
    static const unsigned may_have[] = {
        [DALCS_GATE_AND] = 31,   [DALCS_GATE_OR] = 31,   [DALCS_GATE_XOR] = 31,
        [DALCS_GATE_BUFFER] = 1, [DALCS_GATE_LATCH] = 3, [DALCS_GATE_FLIP_FLOP] = 29};
    const struct dalcs_token *name = of->card->token;
    const unsigned may = may_have[of->gate->kind] | (of->is_schmitt ? 2U : 0U);
    int n = 0;
    for (int pin = 0; pin < DALCS_GATE_INPUTS; pin++) {
        const bool is_wired = of->node[pin] != of->node[PIN_COMMON];
        n += is_wired;
        if (is_wired && (may >> pin & 1U) == 0) {
            dalcs_builder_error(builder, &name[1 + pin], "tie it to com",
                                "pin %d of '%s' means nothing for this function", pin + 1,
                                name->text);
            return false;
        }
    }
    if (n == 0 || (n > 2 && of->gate->kind == DALCS_GATE_XOR)) {
        dalcs_builder_error(builder, name, USAGE,
                            n == 0 ? "no input of '%s' is wired"
                                   : "'%s' is an XOR of more than two inputs, which is not "
                                     "supported: write a chain of them",
                            name->text);
        return false;
    }
    return true;
}

void dalcs_logic_resolve(struct dalcs_builder *builder) {
    if (builder->gate_card == NULL) {
        return;
    }
    const size_t n_nodes = (size_t)builder->circuit->n_nodes;
    const struct dalcs_logic_card **driver =
        dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(const struct dalcs_logic_card *));
    builder->read_by_gates = dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(bool));
    if (driver == NULL || builder->read_by_gates == NULL) {
        builder->out_of_memory = true;
        return;
    }
    builder->n_nodes_of_gates = n_nodes;
    for (const struct dalcs_logic_card *of = builder->gate_card; of != NULL; of = of->before) {
        driver[of->node[PIN_OUTPUT]] = of->gate->output[0] >= 0 ? of : driver[of->node[PIN_OUTPUT]];
        if (of->gate->output[1] >= 0) {
            driver[of->node[PIN_INVERTED]] = of;
        }
    }
    for (const struct dalcs_logic_card *of = builder->gate_card; of != NULL; of = of->before) {
        for (int pin = 0; check_inputs(builder, of) && pin < DALCS_GATE_INPUTS; pin++) {
            if (!(of->is_schmitt && pin > 0)) {
                resolve_input(builder, driver, of, pin);
            }
        }
    }
}
