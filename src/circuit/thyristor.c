/* thyristor.c - thyristors, GTOs and triacs: A cards whose model is one.
 *
 *     Aname anode cathode gate [reference] model         .model name thyristor(Vgt=0.5 Ih=0 Ron=0 Vfwd=0)
 *
 * A thyristor is an ideal diode in series with a switch of the element's name that keeps closed what closed it. Its
 * control is a sum of which each part is a straight line cut off at both ends, with v of the gate against its
 * reference, i the current and u the voltage of the whole; the switch closes above 1.5 and opens below -0.5:
 *     with Ih      2.5 v/Vgt in [0, 3]  +  i/Ih - 1.5 in [-1, 0]       opens where i has fallen to Ih
 *     without Ih   1.5 v/Vgt in [0, 2]                                 opens where the diode blocks
 *     of a GTO     besides 0.5 v/Vgoff in [-3, 0]                      opens where v has fallen to -Vgoff
 * so that all three limits are exact. In both a gate above Vgt closes it and holds it, whatever the current.
 *
 * The diode is the valve of the switch (system.h): while it blocks, the switch is closed above 1.5 alone. So the end of the
 * current is where the diode ends it, whatever voltage follows. A diode against a thyristor, a contactor across it or a
 * short way around it leave none.
 *
 * With a latching current Il it opens with its gate, unless another switch, which closes where i has fallen to Ih and
 * opens where it has reached Il, has opened: while that is closed, 1 is taken from the control, whose part of i is not
 * there then.
 *
 * A triac is two of them, the one against the other, whose v is |v| and whose i is that of the terminal, in the
 * direction of each: how two ideal diodes against each other share a current is not determined, what both together
 * carry is. Without Ih its control is
 *     4 where v > Vgt, else 0   +   0.5 u/Voff in [-1, 0]   +   0.5 i/Ioff in [-1, 0],
 * the last only where Vfwd < Voff, as u stays at 0 then while the other half carries: once the gate is off a half opens
 * by what the other carries. The gate jumps, so that it closes both at Vgt whatever flows: a half that waited for the
 * current of the other to fall to Ioff would close where that is a millionth of what it was, and there no sign can be
 * told from rounding. Formulas that only read are in no loop with what they read: the circuit stays passive
 * (theory.md, section 10). */
#include "thyristor.h"
#include "element_cards.h"
#include "formula_writer.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

enum { VGT, VGOFF, IH, IL, VOFF, IOFF, RON, VFWD, N_PARAMETERS };

static const char MODEL_USAGE[] =
    "a thyristor's model is: .model name thyristor|triac|gto [(Vgt=volts Ih=amperes Ron=ohms "
    "Vfwd=volts)]";
static const char USAGE[] = "a thyristor is: Aname anode cathode gate [reference] model";

/* ---- The model ------------------------------------------------------------------------------------- */

static bool report_parameter(struct dalcs_reader *reader, const struct dalcs_token *name) {
    static const char *const ours[] = {"vgt", "vgoff", "ih", "il", "voff", "ioff", "ron", "vfwd"};
    static const char *const others[] = {"ilatch", "igt", "tq", "vdrm", "vrrm"};
    struct dalcs_builder *builder = reader->builder;
    if (dalcs_builder_is_label(name->text)) {
        return false;
    }
    if (dalcs_builder_is_one_of(name->text, others, sizeof others / sizeof others[0])) {
        dalcs_builder_error(builder, name,
                            "leave it out: Il= and Ih= are its currents, Vgt= the gate's voltage",
                            "'%s' of an ideal thyristor has no meaning here", name->text);
        return true;
    }
    dalcs_builder_error(builder, name,
                        dalcs_builder_suggest_of(builder, ours, sizeof ours / sizeof ours[0],
                                                 name->text, MODEL_USAGE),
                        "a thyristor's model has no parameter '%s'", name->text);
    return true;
}

static bool check(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    for (int k = 0; k < N_PARAMETERS; k++) {
        const bool may_be_zero = k == IH || k == IL || k == RON || k == VFWD;
        if (p[k].value < 0 || (p[k].value == 0 && !may_be_zero)) {
            dalcs_builder_error(builder, p[k].place, MODEL_USAGE,
                                may_be_zero ? "'%s' cannot be negative" : "'%s' must be positive",
                                p[k].name);
            return false;
        }
    }
    if (p[IL].value > 0 && p[IL].value < p[IH].value) {
        dalcs_builder_error(builder, p[IL].place, "exchange the two",
                            "the latching current cannot be below the holding current");
        return false;
    }
    return true;
}

struct dalcs_thyristor *dalcs_thyristor_parse_model(struct dalcs_reader *reader,
                                                    const struct dalcs_token *type,
                                                    struct dalcs_diode_model *valve) {
    struct dalcs_builder *builder = reader->builder;
    const bool is_triac = strcmp(type->text, "triac") == 0;
    struct dalcs_parameter p[N_PARAMETERS] = {
        [VGT] = {"vgt", DALCS_VOLTAGE, false, 0.5, NULL},
        [VGOFF] = {"vgoff", DALCS_VOLTAGE, false, 0.5, NULL},
        [IH] = {"ih", DALCS_CURRENT, false, 0, NULL},
        [IL] = {"il", DALCS_CURRENT, false, 0, NULL},
        [VOFF] = {"voff", DALCS_VOLTAGE, false, 1e-3, NULL},
        [IOFF] = {"ioff", DALCS_CURRENT, false, 1e-6, NULL},
        [RON] = {"ron", DALCS_OHM, false, 0, NULL},
        [VFWD] = {"vfwd", DALCS_VOLTAGE, false, 0, NULL},
    };
    reader->usage = MODEL_USAGE;
    if (!dalcs_model_read_parameters(reader, p, N_PARAMETERS, report_parameter) ||
        !check(builder, p)) {
        return NULL;
    }
    struct dalcs_thyristor *t = dalcs_arena_alloc(&builder->scratch, 1, sizeof *t);
    if (t == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *t = (struct dalcs_thyristor){.kind = is_triac                         ? DALCS_TRIAC
                                          : strcmp(type->text, "gto") == 0 ? DALCS_GTO
                                                                           : DALCS_THYRISTOR,
                                  .trigger = p[VGT].value,
                                  .turn_off = p[VGOFF].value,
                                  .holding = p[IH].place != NULL ? p[IH].value : 0.5 * p[IL].value,
                                  .latching = p[IL].value,
                                  .reversed = p[VOFF].value,
                                  .other = p[IOFF].value,
                                  .drop = p[VFWD].value};
    valve->ron = valve->rrev = p[RON].value;
    valve->vfwd = p[VFWD].value;
    valve->roff = valve->vrev = INFINITY;
    if (t->latching > 0 && t->holding == 0) {
        dalcs_builder_error(builder, p[IH].place, "leave Ih out: it is half of Il then",
                            "with a latching current there is a holding current above 0");
        return NULL;
    }
    if (p[VGOFF].place != NULL && t->kind != DALCS_GTO) {
        dalcs_builder_error(builder, p[VGOFF].place, "make it a gto", "no gate turns a %s off",
                            type->text);
        return NULL;
    }
    return t;
}

/* ---- The element ---------------------------------------------------------------------------------------- */

/* A node that is at 1 V until the current has reached Il, and from Ih down; -1 after an error. */
static int add_latch(struct dalcs_builder *builder, const struct dalcs_thyristor *t,
                     const struct dalcs_token *name, const struct dalcs_thyristor_places *places) {
    struct dalcs_formula_writer w;
    if (!dalcs_formula_writer_start(&w, builder, name)) {
        builder->out_of_memory = true;
        return -1;
    }
    const struct dalcs_token *formula = dalcs_formula_token(
        &w, dalcs_formula_operation(
                &w, DALCS_MULTIPLY, dalcs_formula_number(&w, places->direction / t->holding),
                dalcs_formula_signal(&w, DALCS_FORMULA_CURRENT, places->self, NULL)));
    const int current =
        formula != NULL ? dalcs_behavioural_add_readout(builder, formula, "current", name) : -1;
    const int one = dalcs_builder_inner_node(builder, "one", name);
    const int node = dalcs_builder_inner_node(builder, "unlatched", name);
    struct dalcs_device *s =
        dalcs_builder_add_inner_device(builder, DALCS_SWITCH, "unlatched", name);
    struct dalcs_device *r =
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, "unlatched", name);
    struct dalcs_device *v = dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, "one", name);
    const double ratio = t->latching / t->holding;
    const struct dalcs_switch_model model = {.name = "latch",
                                             .roff = (double)INFINITY,
                                             .vt = -0.5 * (1 + ratio),
                                             .vh = 0.5 * (ratio - 1)};
    const int index = dalcs_switch_add_model(builder, &model);
    if (current < 0 || one < 0 || node < 0 || s == NULL || r == NULL || v == NULL || index < 0) {
        return -1;
    }
    s->node[0] = v->node[0] = one;
    s->node[1] = r->node[0] = node;
    s->node[3] = current;
    s->model = index;
    s->initially_on = s->has_initial_state = true;
    r->value = 1;
    v->stimulus = builder->circuit->n_stimuli++;
    builder->circuit->stimulus[v->stimulus] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true, .dc = 1};
    return node;
}

/* A half: its switch, from `anode` to `cathode` through a diode. */
static bool expand_half(struct dalcs_builder *builder, const struct dalcs_token *element,
                        struct dalcs_device *half, const struct dalcs_model *model,
                        const struct dalcs_thyristor_places *places) {
    const bool is_back = strcmp(half->name, element->text) != 0;
    const int anode = half->node[0];
    const int inside =
        dalcs_builder_inner_node(builder, is_back ? "inside_back" : "inside", element);
    struct dalcs_device *valve = dalcs_builder_add_inner_device(
        builder, DALCS_DIODE, is_back ? "back_valve" : "valve", element);
    const struct dalcs_switch_model latch = {
        .name = model->name->text, .roff = (double)INFINITY, .vt = 0.5, .vh = 1};
    half->model = dalcs_switch_add_model(builder, &latch);
    if (inside < 0 || valve == NULL || half->model < 0) {
        builder->out_of_memory = true;
        return false;
    }
    struct dalcs_token *name = dalcs_formula_name(builder, element, half->name);
    const struct dalcs_token *formula = dalcs_thyristor_control(builder, model->thyristor, places);
    const int node = formula != NULL && name != NULL
                         ? dalcs_behavioural_add_readout(builder, formula, "control", name)
                         : -1;
    if (node < 0) {
        return false;
    }
    valve->node[0] = anode;
    valve->node[1] = half->node[0] = inside;
    valve->model = model->index;
    half->valve = (int)(valve - builder->circuit->device);
    half->node[2] = node;
    if (model->thyristor->latching > 0) {
        const int unlatched = add_latch(builder, model->thyristor, name, places);
        half->node[3] = unlatched >= 0 ? unlatched : 0;
        return unlatched >= 0;
    }
    return true;
}

/* The other half of a triac. */
static bool expand_back(struct dalcs_builder *builder, const struct dalcs_token *element,
                        const int *node, const struct dalcs_model *model,
                        const struct dalcs_thyristor_places *places) {
    struct dalcs_device *back =
        dalcs_builder_add_inner_device(builder, DALCS_SWITCH, "back", element);
    if (back == NULL) {
        return false;
    }
    back->node[0] = node[1];
    back->node[1] = node[0];
    struct dalcs_thyristor_places turned = *places;
    turned.anode = places->cathode;
    turned.cathode = places->anode;
    turned.direction = -1;
    return expand_half(builder, element, back, model, &turned);
}

bool dalcs_thyristor_is(const struct dalcs_builder *builder, const struct dalcs_card *card) {
    const int index = dalcs_names_find(&builder->models.names, card->token[card->n - 1].text);
    return index >= 0 && builder->models.model[index].kind == DALCS_MODEL_THYRISTOR;
}

void dalcs_thyristor_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    const int n_nodes = card->n - 2;
    int node[4];
    if (n_nodes != 3 && n_nodes != 4) {
        dalcs_builder_error(builder, card->token, USAGE, "a thyristor has 3 or 4 nodes, not %d",
                            n_nodes);
        return;
    }
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_SWITCH, card->token);
    if (device == NULL || !dalcs_reader_nodes(&reader, n_nodes, node)) {
        return;
    }
    const struct dalcs_model *model =
        &builder->models
             .model[dalcs_names_find(&builder->models.names, card->token[card->n - 1].text)];
    const struct dalcs_token *token = card->token;
    const struct dalcs_thyristor_places places = {
        &token[1], &token[2], &token[3], n_nodes == 4 ? &token[4] : &token[2], token, 1};
    const bool is_triac = model->thyristor->kind == DALCS_TRIAC;
    device->node[0] = node[0];
    device->node[1] = node[1];
    if (is_triac && !dalcs_builder_add_terminal(builder, token, device)) {
        return;
    }
    const int both[2] = {device->node[0], node[1]};
    if (!expand_half(builder, token, device, model, &places)) {
        return; /* it has said what is wrong */
    }
    if (is_triac) {
        (void)expand_back(builder, token, both, model, &places);
    }
}
