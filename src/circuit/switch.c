/* switch.c - S and W elements: switches controlled by a voltage or by a current. */
#include "element_cards.h"
#include "formula.h"
#include "model_cards.h"
#include "reader.h"

#include <string.h>

static const char USAGE[] = "a switch is: Sname node node control control model [ON|OFF]";
static const char FORMULA_USAGE[] =
    "such a switch is: Sname node node model [ON|OFF] CONTROL={expression}";
static const char CURRENT_USAGE[] = "a switch is: Wname node node Vsource model [ON|OFF]";

/* Lser and Vser of the model, between the switch's first node and the switch. */
static void add_series(struct dalcs_builder *builder, const struct dalcs_token *element,
                       struct dalcs_device *device) {
    struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_switch_model *model = &circuit->models.of_switch[device->model];
    for (int k = 0; k < 2; k++) {
        const bool is_coil = k == 0;
        if ((is_coil ? model->lser : model->vser) == 0) {
            continue;
        }
        const char *what = is_coil ? "lser" : "vser";
        const int next =
            dalcs_builder_inner_node(builder, is_coil ? "after_lser" : "inside", element);
        struct dalcs_device *part = dalcs_builder_add_inner_device(
            builder, is_coil ? DALCS_INDUCTOR : DALCS_VSOURCE, what, element);
        if (next < 0 || part == NULL) {
            return;
        }
        part->node[0] = device->node[0];
        part->node[1] = next;
        device->node[0] = next;
        if (is_coil) {
            part->value = model->lser;
        } else {
            part->stimulus = circuit->n_stimuli++;
            circuit->stimulus[part->stimulus] = (struct dalcs_stimulus){
                .kind = DALCS_STIMULUS_DC, .dc = model->vser, .has_dc = true};
        }
    }
}

/* m switches in parallel have a model of their own. */
static void multiply(struct dalcs_builder *builder, struct dalcs_device *device, double m) {
    struct dalcs_switch_model model = builder->circuit->models.of_switch[device->model];
    model.ron /= m;
    model.roff /= m;
    model.lser /= m;
    model.ilimit *= m;
    device->model = dalcs_switch_add_model(builder, &model);
}

/* Xyce takes PSpice's ISWITCH for an S, too: thresholds are numbers, and what has the two nodes
 * between them is volts. A model that was refused may have no type. */
static bool is_taken_for_volts(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const int index = dalcs_names_find(&builder->models.names, name->text);
    if (index < 0 || builder->models.model[index].kind != DALCS_MODEL_CURRENT_SWITCH ||
        strcmp(builder->models.model[index].type->text, "iswitch") != 0) {
        return false;
    }
    dalcs_builder_warn(builder, name, "a VSWITCH has Von and Voff",
                       "model '%s' is an ISWITCH, of amperes: this switch compares the voltage "
                       "between its control nodes with them, in volts, as Xyce's does",
                       name->text);
    return true;
}

/* Devices in parallel, a resistance and limits of the current, as its model has them. */
static void expand_model(struct dalcs_builder *builder, const struct dalcs_card *card,
                         struct dalcs_device *device) {
    if (device->model >= 0 && card->parallel > 0) {
        multiply(builder, device, card->parallel);
    }
    if (device->model >= 0) {
        const double most = builder->circuit->models.of_switch[device->model].ilimit;
        add_series(builder, card->token, device);
        dalcs_current_limit_expand(
            builder, card->token, device,
            &(struct dalcs_current_limits){.forward = most, .reverse = most});
    }
}

void dalcs_switch_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    const bool by_current = card->letter == 'w';
    const bool by_formula = !by_current && dalcs_formula_find_control(card) < card->n;
    struct dalcs_reader reader = dalcs_reader_start(builder, card,
                                                    by_current   ? CURRENT_USAGE
                                                    : by_formula ? FORMULA_USAGE
                                                                 : USAGE);
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_SWITCH, card->token);
    const struct dalcs_token *model;
    if (device == NULL ||
        !dalcs_reader_nodes(&reader, by_current || by_formula ? 2 : 4, device->node)) {
        return;
    }
    if (by_current &&
        !dalcs_reader_name(&reader, "the name of a voltage source",
                           &builder->elements.control_token[device - builder->circuit->device])) {
        return;
    }
    if (!dalcs_reader_name(&reader, "the name of a model", &model)) {
        return;
    }
    device->model =
        by_formula || (!by_current && is_taken_for_volts(builder, model))
            ? dalcs_model_find_switch(builder, model)
            : dalcs_model_find(builder, model,
                               by_current ? DALCS_MODEL_CURRENT_SWITCH : DALCS_MODEL_SWITCH);
    device->initially_on = dalcs_reader_take_word(&reader, "on");
    device->has_initial_state = device->initially_on || dalcs_reader_take_word(&reader, "off");
    if (device->model >= 0 && builder->circuit->models.of_switch[device->model].is_exchanged) {
        device->initially_on = !device->initially_on;
    }
    const struct dalcs_token *control = by_formula ? dalcs_reader_peek(&reader, 0) : NULL;
    if (control != NULL && strcmp(control->text, "control") == 0 &&
        dalcs_reader_take_parameter(&reader) != NULL) {
        const int node = dalcs_behavioural_parse_control(&reader, card->token);
        if (node < 0) {
            return;
        }
        device->node[2] = node;
    }
    dalcs_reader_end(&reader);
    expand_model(builder, card, device);
}
