/* logic_card.c - LTspice's gates, flip-flops, counters and samples.
 *
 *     Aname in1 in2 in3 in4 in5 qbar q com FUNCTION [Vhigh=1 Vlow=0 Ref=middle Td=0 Trise=0 Tfall=Trise Vt=0 Vh=0 ...]
 *
 * A pin that is tied to com is not there. */
#include "block_parts.h"
#include "element_cards.h"
#include "logic_parts.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const char USAGE[] =
    "a gate is: Aname in1 in2 in3 in4 in5 qbar q com FUNCTION [Vhigh=volts Vlow=volts Ref=volts "
    "Td=seconds Trise=seconds Tfall=seconds], pins that are not used tied to com";

enum { PIN_INVERTED = DALCS_GATE_PINS, PIN_OUTPUT, PIN_COMMON, N_PINS };

enum {
    VHIGH,
    VLOW,
    REF,
    TD,
    TRISE,
    TFALL,
    VT,
    VH,
    ROUT,
    RHIGH,
    RLOW,
    COUT,
    TAU,
    IC,
    CYCLES,
    DUTY,
    N_PARAMETERS
};

struct function {
    const char *name;
    enum dalcs_logic_kind kind;
    unsigned pins;  /* that it may have, besides those of a Schmitt trigger */
    unsigned wants; /* parameters besides those of all, a bit each */
};

struct card {
    const struct dalcs_card *card;
    const struct function *function;
    struct dalcs_logic_card *of;
    int node[N_PINS];
    bool is_schmitt, reads_common;
    double lower, upper; /* V, of a sample */
    struct dalcs_parameter p[N_PARAMETERS];
};

static const struct function *find_function(const char *word) {
    enum { LEVELS = 1 << VT | 1 << VH, COUNT = 1 << CYCLES | 1 << DUTY };

    static const struct function functions[] = {
        {"and", DALCS_GATE_AND, 31, LEVELS},         {"or", DALCS_GATE_OR, 31, LEVELS},
        {"xor", DALCS_GATE_ONE, 31, LEVELS},         {"srflop", DALCS_GATE_LATCH, 3, LEVELS},
        {"dflop", DALCS_GATE_FLIP_FLOP, 29, LEVELS}, {"counter", DALCS_GATE_COUNTER, 3, COUNT},
        {"samplehold", DALCS_GATE_SAMPLE, 15, 0},    {"", DALCS_GATE_BUFFER, 1, LEVELS}};
    int k = 0;
    while (functions[k].name[0] != '\0' && strcmp(word, functions[k].name) != 0) {
        k++;
    }
    return &functions[k];
}

/* ---- The card ----------------------------------------------------------------------------------------- */

static bool is_wired(const struct card *c, int pin) {
    return c->node[pin] != c->node[PIN_COMMON];
}

static bool find_kind(struct dalcs_builder *builder, struct card *c) {
    const struct dalcs_token *word = &c->card->token[DALCS_LOGIC_MODEL];
    c->function = find_function(word->text);
    c->is_schmitt = strstr(word->text, "schm") != NULL;
    if (strstr(word->text, "inv") != NULL && is_wired(c, PIN_OUTPUT)) {
        dalcs_builder_error(builder, word,
                            "wire the sixth pin, the complement, and tie the seventh to com",
                            "the output of an inverter is its pin qbar");
        return false;
    }
    return true;
}

/* Vhigh and Vlow are levels of all but samples, whose input they limit; no time passes in those. */
static bool has_parameter(const struct card *c, int k) {
    const bool is_sample = c->function->kind == DALCS_GATE_SAMPLE;
    const bool is_special = k == VT || k == VH || k == CYCLES || k == DUTY;
    return is_special ? (c->function->wants >> k & 1U) != 0
                      : !is_sample || k <= REF || k == ROUT || k == COUT || k == TAU || k == IC;
}

static bool read_parameters(struct dalcs_reader *reader, struct card *c) {
    const struct dalcs_logic_parameters parameters = {
        c->function->kind >= DALCS_GATE_COUNTER ? c->function->name : "a gate", c->p, N_PARAMETERS,
        false};
    for (int k = 0; k < N_PARAMETERS; k++) {
        c->p[k].name = has_parameter(c, k) ? c->p[k].name : NULL;
    }
    return dalcs_logic_read_parameters(reader, &parameters);
}

/* Of a sample Vhigh and Vlow bound what it takes, and say nothing of its clock: Ref stays where it is without them. */
static void take_limits(struct card *c) {
    struct dalcs_parameter *high = &c->p[VHIGH];
    struct dalcs_parameter *low = &c->p[VLOW];
    const bool is_sample = c->function->kind == DALCS_GATE_SAMPLE;
    c->upper = is_sample && high->place != NULL ? high->value : (double)INFINITY;
    c->lower = is_sample && low->place != NULL ? low->value : -(double)INFINITY;
    high->value = is_sample ? 1 : high->value;
    low->value = is_sample ? 0 : low->value;
}

/* A ramp, a time constant, a resistance with a capacitance: ways to say how an output goes from level to level. */
static bool check_ways(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    static const struct {
        int one, other;
    } pairs[] = {{TAU, TRISE}, {TAU, TFALL}, {TAU, COUT}, {TAU, RHIGH}, {TAU, RLOW}};

    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++) {
        const struct dalcs_parameter *one = &p[pairs[k].one];
        const struct dalcs_parameter *other = &p[pairs[k].other];
        if (one->place != NULL && other->place != NULL && one->value > 0 && other->value > 0) {
            dalcs_builder_error(builder, other->place, "leave one of them out",
                                "'%s' and '%s' of one output", one->name, other->name);
            return false;
        }
    }
    return true;
}

static bool check_parameters(struct dalcs_builder *builder, const struct card *c) {
    const struct dalcs_parameter *p = c->p;
    static const int not_negative[] = {TD, TRISE, TFALL, VH, ROUT, RHIGH, RLOW, COUT, TAU};
    for (size_t k = 0; k < sizeof not_negative / sizeof not_negative[0]; k++) {
        const struct dalcs_parameter *one = &p[not_negative[k]];
        if (one->value < 0) {
            dalcs_builder_error(builder, one->place, USAGE, "'%s' cannot be negative", one->name);
            return false;
        }
    }
    if (!check_ways(builder, p)) {
        return false;
    }
    if (!(p[VHIGH].value > p[VLOW].value) || !(c->upper > c->lower)) {
        dalcs_builder_error(builder, p[VHIGH].place != NULL ? p[VHIGH].place : p[VLOW].place,
                            "exchange the two, and use the other output",
                            "Vhigh must be above Vlow");
        return false;
    }
    if (!(p[CYCLES].value >= 2 && p[CYCLES].value < 1e9) ||
        floor(p[CYCLES].value) != p[CYCLES].value) {
        dalcs_builder_error(builder, p[CYCLES].place, NULL,
                            "cycles= of a counter is a whole number of clocks from 2 on");
        return false;
    }
    if (!(p[DUTY].value > 0 && p[DUTY].value < 1)) {
        dalcs_builder_error(builder, p[DUTY].place, NULL,
                            "duty= of a counter is above 0 and below 1");
        return false;
    }
    return true;
}

/* A capacitance without a resistance has LTspice's 1 ohm. */
static void take_impedance(struct dalcs_logic_card *of, const struct dalcs_parameter *p) {
    const bool has_capacitance = p[COUT].value > 0 || p[TAU].value > 0;
    const double ohms = p[ROUT].value > 0 || !has_capacitance ? p[ROUT].value : 1;
    of->ohms[0] = p[RLOW].place != NULL ? p[RLOW].value : ohms;
    of->ohms[1] = p[RHIGH].place != NULL ? p[RHIGH].value : ohms;
    of->may_resist = !(of->ohms[0] > 0) && !(of->ohms[1] > 0) && p[ROUT].place == NULL;
    of->farad = p[TAU].value > 0 ? p[TAU].value / ohms : p[COUT].value;
}

static void take_parameters(struct card *c) {
    struct dalcs_logic_card *of = c->of;
    struct dalcs_logic_gate *g = of->gate;
    const struct dalcs_parameter *p = c->p;
    g->kind = c->function->kind;
    g->low = p[VLOW].value;
    g->high = p[VHIGH].value;
    g->delay[0] = g->delay[1] = g->forced_delay[0] = g->forced_delay[1] = p[TD].value;
    g->rise = p[TRISE].value;
    g->fall = p[TFALL].place != NULL ? p[TFALL].value : p[TRISE].value;
    if (g->kind == DALCS_GATE_SAMPLE) {
        g->held = fmin(fmax(p[IC].place != NULL ? p[IC].value : 0, c->lower), c->upper);
    } else if (g->kind == DALCS_GATE_COUNTER) {
        g->cycles = (int)p[CYCLES].value;
        const double n_high = round(p[DUTY].value * g->cycles);
        g->n_high = (int)fmin(fmax(n_high, 1), g->cycles - 1);
        g->first = p[IC].place != NULL && p[IC].value > 0.5 * (g->low + g->high);
        g->initial = g->first > 0;
    } else {
        g->initial = p[IC].place != NULL && p[IC].value > 0.5 * (g->low + g->high);
    }
    const double ref = p[REF].place != NULL ? p[REF].value : g->low + 0.5 * (g->high - g->low);
    of->on = c->is_schmitt ? p[VT].value + p[VH].value : ref;
    of->off = c->is_schmitt ? p[VT].value - p[VH].value : ref;
    take_impedance(of, p);
}

/* ---- Pins ------------------------------------------------------------------------------------------------ */

/* Pins that mean nothing for this function, which LTspice ignores, too, and inputs that it must have. */
static bool check_pins(struct dalcs_builder *builder, struct card *c) {
    const struct dalcs_token *name = c->card->token;
    const unsigned may = c->function->pins | (c->is_schmitt ? 2U : 0U);
    int n = 0;
    for (int pin = 0; pin <= PIN_INVERTED; pin++) {
        n += is_wired(c, pin) && pin < DALCS_GATE_PINS;
        const bool means =
            pin < DALCS_GATE_PINS ? (may >> pin & 1U) != 0 : c->function->kind != DALCS_GATE_SAMPLE;
        if (is_wired(c, pin) && !means) {
            dalcs_builder_warn(builder, &name[1 + pin], "tie it to com",
                               "this function does not use pin %d of '%s': it is ignored", pin + 1,
                               name->text);
            n -= pin < DALCS_GATE_PINS;
        }
    }
    /* A call may have put all ports of a subcircuit that it reads on com: then its input is that voltage. */
    if (n == 0 && strchr(name->text, '.') == NULL) {
        dalcs_builder_error(builder, name, USAGE, "no input of '%s' is wired", name->text);
        return false;
    }
    if (n == 0) {
        dalcs_builder_warn(builder, name, NULL, "all inputs of '%s' are on com: they are low",
                           name->text);
        c->reads_common = true;
    }
    return true;
}

static bool has_output(struct dalcs_builder *builder, const struct card *c) {
    const bool has_complement = c->function->kind != DALCS_GATE_SAMPLE;
    const bool has = is_wired(c, PIN_OUTPUT) || (has_complement && is_wired(c, PIN_INVERTED));
    if (!has) {
        dalcs_builder_warn(builder, c->card->token, USAGE,
                           "no output of '%s' is wired: the element is left out",
                           c->card->token->text);
    }
    return has;
}

/* What a sample takes: its input between its limits. */
static struct dalcs_logic_sampled sampled(struct dalcs_builder *builder, const struct card *c) {
    const struct dalcs_block_card block = {.builder = builder, .card = c->card};
    const bool has_lower = dalcs_block_is_level(c->lower);
    const bool has_upper = dalcs_block_is_level(c->upper);
    const struct dalcs_logic_sampled all = {c->node[0], c->node[1]};
    if (!has_lower && !has_upper) {
        return all;
    }
    const int node = dalcs_builder_inner_node(builder, "limited", c->card->token);
    struct dalcs_device *e = dalcs_block_add(&block, DALCS_VCVS, "limited", node, 0);
    struct dalcs_piecewise table = dalcs_block_make_table(&block, has_lower + has_upper);
    if (node < 0 || e == NULL || table.knot == NULL) {
        return all;
    }
    if (has_lower) {
        dalcs_block_set_knot(&table, 0, c->lower, c->lower);
    }
    if (has_upper) {
        dalcs_block_set_knot(&table, has_lower, c->upper, c->upper);
    }
    table.before = has_lower ? 0 : 1;
    table.after = has_upper ? 0 : 1;
    table.has_zero = true;
    table.zero = fmin(fmax(0, c->lower), c->upper);
    dalcs_block_control(e, &(struct dalcs_block_end){.node = all.node, .reference = all.reference},
                        1);
    dalcs_behavioural_add_table(builder, e, &table);
    return (struct dalcs_logic_sampled){node, 0};
}

static void take_pins(struct dalcs_builder *builder, struct card *c) {
    struct dalcs_logic_card *of = c->of;
    const bool is_sample = c->function->kind == DALCS_GATE_SAMPLE;
    const int common = c->node[PIN_COMMON];
    for (int pin = is_sample ? DALCS_GATE_CLOCK : 0; pin < DALCS_GATE_PINS; pin++) {
        of->pin[pin] = (struct dalcs_logic_pin){
            .is_wired = is_wired(c, pin), .node = c->node[pin], .reference = common};
    }
    of->pin[0].is_wired = of->pin[0].is_wired || (c->reads_common && !is_sample);
    if (c->is_schmitt) {
        of->pin[0].is_wired = is_wired(c, 0) || is_wired(c, 1) || c->reads_common;
        of->pin[0].reference = c->node[1];
        of->pin[1].is_wired = false;
    }
    for (int k = 0; k < 2; k++) {
        const int pin = k == 0 ? PIN_OUTPUT : PIN_INVERTED;
        of->node[k] = is_wired(c, pin) && !(is_sample && k == 1) ? c->node[pin] : -1;
    }
    of->common = common;
    if (is_sample) {
        of->sampled = sampled(builder, c);
    }
}

void dalcs_logic_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct card c = {.card = card,
                     .of = dalcs_logic_start(builder, card->token, DALCS_GATE_PINS),
                     .p = {[VHIGH] = {"vhigh", DALCS_VOLTAGE, false, 1, NULL},
                           [VLOW] = {"vlow", DALCS_VOLTAGE, false, 0, NULL},
                           [REF] = {"ref", DALCS_VOLTAGE, false, 0, NULL},
                           [TD] = {"td", DALCS_SECOND, false, 0, NULL},
                           [TRISE] = {"trise", DALCS_SECOND, false, 0, NULL},
                           [TFALL] = {"tfall", DALCS_SECOND, false, 0, NULL},
                           [VT] = {"vt", DALCS_VOLTAGE, false, 0, NULL},
                           [VH] = {"vh", DALCS_VOLTAGE, false, 0, NULL},
                           [ROUT] = {"rout", DALCS_OHM, false, 0, NULL},
                           [RHIGH] = {"rhigh", DALCS_OHM, false, 0, NULL},
                           [RLOW] = {"rlow", DALCS_OHM, false, 0, NULL},
                           [COUT] = {"cout", DALCS_FARAD, false, 0, NULL},
                           [TAU] = {"tau", DALCS_SECOND, false, 0, NULL},
                           [IC] = {"ic", DALCS_VOLTAGE, false, 0, NULL},
                           [CYCLES] = {"cycles", DALCS_PLAIN, false, 2, NULL},
                           [DUTY] = {"duty", DALCS_PLAIN, false, 0.5, NULL}}};
    if (c.of == NULL || dalcs_analog_function_parse(builder, card) ||
        !dalcs_reader_nodes(&reader, N_PINS, c.node)) {
        return;
    }
    reader.at++; /* the function */
    bool ok = find_kind(builder, &c) && read_parameters(&reader, &c);
    if (ok) {
        take_limits(&c);
        for (int k = VT; k <= VH && !c.is_schmitt; k++) {
            dalcs_logic_ignore_threshold(&reader, &c.p[k], card->token[DALCS_LOGIC_MODEL].text);
        }
        ok = check_parameters(builder, &c);
        if (ok && !has_output(builder, &c)) {
            return;
        }
        ok = ok && check_pins(builder, &c);
    }
    if (!ok) {
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    take_parameters(&c);
    take_pins(builder, &c);
    dalcs_logic_add(builder, c.of);
}
