/* model.c - .model cards.
 *
 * Models are read before the elements, so they may stand anywhere in the netlist. */
#include "block.h"
#include "model_cards.h"
#include "number.h"
#include "reader.h"

#include <string.h>

static const char USAGE[] =
    "a model is: .model name D|SW|CSW|VDMOS|NIGBT|SCR|TRIAC [(parameter=value ...)]";

struct type {
    const char *name;
    enum dalcs_model_kind kind;
    const char *what;
};

static const struct type *find_type(const char *name) {
    static const struct type types[] = {
        {"d", DALCS_MODEL_DIODE, "diode"},
        {"sw", DALCS_MODEL_SWITCH, "switch"},
        {"vswitch", DALCS_MODEL_SWITCH, "switch"},
        {"csw", DALCS_MODEL_CURRENT_SWITCH, "current controlled switch"},
        {"iswitch", DALCS_MODEL_CURRENT_SWITCH, "current controlled switch"},
        {"switch", DALCS_MODEL_SWITCH, "switch"},
        {"sidiode", DALCS_MODEL_DIODE, "diode"},
        {"thyristor", DALCS_MODEL_THYRISTOR, "thyristor"},
        {"scr", DALCS_MODEL_THYRISTOR, "thyristor"},
        {"triac", DALCS_MODEL_THYRISTOR, "triac"},
        {"gto", DALCS_MODEL_THYRISTOR, "thyristor"},
        {"npn", DALCS_MODEL_TRANSISTOR, "transistor"},
        {"pnp", DALCS_MODEL_TRANSISTOR, "transistor"},
        {"lpnp", DALCS_MODEL_OTHER, "transistor"},
        {"njf", DALCS_MODEL_OTHER, "transistor"},
        {"pjf", DALCS_MODEL_OTHER, "transistor"},
        {"nmos", DALCS_MODEL_TRANSISTOR, "transistor"},
        {"pmos", DALCS_MODEL_TRANSISTOR, "transistor"},
        {"vdmos", DALCS_MODEL_TRANSISTOR, "transistor"},
        {"nigbt", DALCS_MODEL_TRANSISTOR, "transistor"},
        {"nmf", DALCS_MODEL_OTHER, "transistor"},
        {"pmf", DALCS_MODEL_OTHER, "transistor"},
        {"r", DALCS_MODEL_PASSIVE, "resistor"},
        {"res", DALCS_MODEL_PASSIVE, "resistor"},
        {"c", DALCS_MODEL_PASSIVE, "capacitor"},
        {"cap", DALCS_MODEL_PASSIVE, "capacitor"},
        {"l", DALCS_MODEL_PASSIVE, "inductor"},
        {"ind", DALCS_MODEL_PASSIVE, "inductor"},
        {"core", DALCS_MODEL_OTHER, "magnetic core"},
        {"ltra", DALCS_MODEL_OTHER, "transmission line"},
        {"urc", DALCS_MODEL_OTHER, "transmission line"},
    };
    static const struct type block = {"", DALCS_MODEL_BLOCK, "code model"};
    for (size_t k = 0; k < sizeof types / sizeof types[0]; k++) {
        if (strcmp(types[k].name, name) == 0) {
            return &types[k];
        }
    }
    return dalcs_block_is_type(name) ? &block : NULL;
}

static bool read_known(struct dalcs_reader *reader, struct dalcs_parameter *parameter,
                       const struct dalcs_token *name) {
    if (parameter->place != NULL) {
        dalcs_builder_error(reader->builder, name, NULL, "'%s' is given twice", name->text);
        return false;
    }
    parameter->place = name;
    return parameter->may_be_infinite
               ? dalcs_reader_number_or_infinity(reader, parameter->quantity, "a value",
                                                 &parameter->value)
               : dalcs_reader_number(reader, parameter->quantity, "a value", &parameter->value);
}

/* `name = value`, or a blank for the equal sign, as in ngspice; NULL, nothing taken, when none follows. */
static const struct dalcs_token *take_parameter(struct dalcs_reader *reader) {
    const struct dalcs_token *behind = dalcs_reader_peek(reader, 1);
    if (behind == NULL || behind->kind != DALCS_TOKEN_EQUAL) {
        (void)dalcs_reader_take_word(reader, "noiseless"); /* LTspice; nothing has noise here */
    }
    const struct dalcs_token *name = dalcs_reader_take_parameter(reader);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *value = dalcs_reader_peek(reader, 1);
    if (name != NULL || next == NULL || next->kind != DALCS_TOKEN_WORD || value == NULL ||
        dalcs_reader_is_number(next)) {
        return name;
    }
    const bool is_infinite = value->kind == DALCS_TOKEN_WORD && strcmp(value->text, "inf") == 0;
    if (!is_infinite && !dalcs_reader_is_number(value)) {
        return NULL;
    }
    reader->at++;
    return next;
}

bool dalcs_model_read_parameters(struct dalcs_reader *reader, struct dalcs_parameter *parameter,
                                 int n,
                                 bool (*unknown)(struct dalcs_reader *reader,
                                                 const struct dalcs_token *name)) {
    bool ok = true;
    const struct dalcs_token *name;
    while ((name = take_parameter(reader)) != NULL) {
        int k = 0;
        while (k < n && strcmp(parameter[k].name, name->text) != 0) {
            k++;
        }
        if (k < n && !read_known(reader, &parameter[k], name)) {
            return false;
        }
        if (k == n) {
            /* A library's card has a dozen of these: one message is enough. */
            ok = ok && !unknown(reader, name);
            if (!dalcs_reader_skip_value(reader)) {
                return false;
            }
        }
    }
    return ok;
}

/* A number as it stands in a card. */
static bool number_of(const struct dalcs_token *token, double *value) {
    struct dalcs_number number = {.value = token->value};
    const bool ok = token->kind == DALCS_TOKEN_NUMBER ||
                    dalcs_number_parse(token->text, &number) == DALCS_NUMBER_OK;
    *value = number.value;
    return ok;
}

/* r=, c= and l=, res=, cap= and ind= of the model's own type. */
static bool is_value_of(const struct dalcs_model *model, const char *name) {
    const char type = model->type->text[0];
    return type == 'r'   ? strcmp(name, "r") == 0 || strcmp(name, "res") == 0
           : type == 'c' ? strcmp(name, "c") == 0 || strcmp(name, "cap") == 0
                         : strcmp(name, "l") == 0 || strcmp(name, "ind") == 0;
}

/* Of an R, L or C the card has the value, or else its model; a model's temperature and noise change nothing here. */
static void read_passive(struct dalcs_reader *reader, struct dalcs_model *model) {
    static const char *const nothing[] = {"kf",     "af",    "ef",          "lf",   "wf",
                                          "bv_max", "level", "t_rel_local", "noise"};
    (void)dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    const struct dalcs_token *name;
    while ((name = take_parameter(reader)) != NULL && dalcs_reader_skip_value(reader)) {
        double value;
        if (is_value_of(model, name->text) && number_of(dalcs_reader_previous(reader), &value)) {
            model->value = value;
            model->has_value = true;
        } else if (dalcs_coefficient_is_name(name->text) &&
                   number_of(dalcs_reader_previous(reader), &value)) {
            dalcs_coefficient_set(&model->coefficients, name->text, value);
        } else if (!dalcs_builder_is_one_of(name->text, nothing,
                                            sizeof nothing / sizeof nothing[0])) {
            model->beyond = model->beyond != NULL ? model->beyond : name;
        }
    }
}

/* What closes the bracket; false after an error. */
static bool take_close(struct dalcs_reader *reader, const struct dalcs_token *open) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    if (dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        return true;
    }
    if (next == NULL && open->text[0] == '(') { /* SPICE takes those of a model for blanks */
        dalcs_builder_warn(reader->builder, open, "end the card with ')'",
                           "this parenthesis is never closed: the model ends with its card");
        return true;
    }
    if (next == NULL) {
        dalcs_builder_error(reader->builder, open, NULL, "this bracket is never closed");
    } else if (next->kind == DALCS_TOKEN_WORD) {
        dalcs_builder_error(reader->builder, next, reader->usage,
                            "'%s' is not of the form parameter=value", next->text);
    } else {
        dalcs_reader_unexpected(reader);
    }
    return false;
}

/* A parenthesis at the end that none opens is a blank, as in SPICE. */
static void skip_stray_close(struct dalcs_reader *reader) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    if (dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_builder_warn(reader->builder, next, "leave it out",
                           "no parenthesis was opened that this one closes");
    }
}

/* Reads the parameters of a D or SW into the circuit; false when an error was reported. */
static bool read_parameters(struct dalcs_reader *reader, struct dalcs_model *model) {
    struct dalcs_circuit *circuit = reader->builder->circuit;
    const char *text = model->name->text;
    const char *name = dalcs_arena_copy(&circuit->arena, text, strlen(text));
    if (name == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    const struct dalcs_token *open = dalcs_reader_peek(reader, 0);
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    bool ok;
    if (model->kind == DALCS_MODEL_DIODE) {
        model->index = circuit->models.n_diodes++;
        circuit->models.of_diode[model->index].name = name;
        ok = dalcs_diode_parse_model(reader, model->type, &model->diode,
                                     &circuit->models.of_diode[model->index]);
    } else if (model->kind == DALCS_MODEL_THYRISTOR) {
        model->index = circuit->models.n_diodes++;
        circuit->models.of_diode[model->index].name = name;
        model->thyristor = dalcs_thyristor_parse_model(reader, model->type,
                                                       &circuit->models.of_diode[model->index]);
        ok = model->thyristor != NULL;
    } else if (model->kind == DALCS_MODEL_BLOCK) {
        model->block = dalcs_block_parse_model(reader, model->name, model->type);
        ok = model->block != NULL;
    } else if (model->kind == DALCS_MODEL_TRANSISTOR) {
        model->transistor = dalcs_transistor_parse_model(reader, model->name, model->type);
        ok = model->transistor != NULL;
    } else {
        model->index = circuit->models.n_switches++;
        circuit->models.of_switch[model->index].name = name;
        ok =
            dalcs_switch_parse_model(reader, model->type, &circuit->models.of_switch[model->index]);
    }
    if (!ok) {
        return false;
    }
    if (opened && !take_close(reader, open)) {
        return false;
    }
    skip_stray_close(reader);
    return dalcs_reader_end(reader);
}

/* What people call a part, and how SPICE calls its model. */
static const char *hint_of_type(struct dalcs_builder *builder, const char *word) {
    static const char *const called[][2] = {
        {"diode", "D"},    {"zener", "D"},     {"mosfet", "VDMOS"}, {"mos", "VDMOS"},
        {"fet", "VDMOS"},  {"igbt", "NIGBT"},  {"bjt", "NPN"},      {"relay", "SW"},
        {"resistor", "R"}, {"capacitor", "C"}, {"inductor", "L"}};
    for (size_t k = 0; k < sizeof called / sizeof called[0]; k++) {
        if (strcmp(called[k][0], word) == 0) {
            return dalcs_builder_hint(builder, "did you mean '%s'?", called[k][1]);
        }
    }
    return USAGE;
}

static bool is_same_card(const struct dalcs_card *a, const struct dalcs_card *b) {
    bool same = a->n == b->n;
    for (int k = 0; k < a->n && same; k++) {
        same = strcmp(a->token[k].text, b->token[k].text) == 0;
    }
    return same;
}

/* `.model D D`, which LTspice writes for each kind of part that its symbols name without a model of their own. */
static bool is_of_symbols(const struct dalcs_card *card) {
    return card->n == 3 && strcmp(card->token[1].text, card->token[2].text) == 0;
}

/* A model of the same name: one that says the same, as where two parts bring their models along, does no harm, and what
 * the author writes comes before what LTspice adds. True: the second counts. */
static bool judge_second(struct dalcs_builder *builder, const struct dalcs_model *first,
                         const struct dalcs_card *card) {
    const struct dalcs_token *name = &card->token[1];
    const char *place = dalcs_builder_place(builder, first->name);
    const bool is_replaced = is_of_symbols(first->card);
    if (is_same_card(first->card, card)) {
        dalcs_builder_note(builder, name, NULL, "this model '%s' is the one at %s once more",
                           name->text, place);
        return false;
    }
    if (is_replaced || is_of_symbols(card)) {
        dalcs_builder_warn(builder, name, "give it another name",
                           "there are two models '%s', the other at %s: the one with parameters "
                           "counts",
                           name->text, place);
        return is_replaced;
    }
    dalcs_builder_error(builder, name, "give it another name",
                        "there are two models '%s', the first at %s", name->text, place);
    return false;
}

void dalcs_model_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    const struct dalcs_token *name;
    const struct dalcs_token *type;
    if (!dalcs_reader_name(&reader, "the name of the model", &name)) {
        return;
    }
    const int first = dalcs_names_find(&builder->models.names, name->text);
    if (first >= 0 && !judge_second(builder, &builder->models.model[first], card)) {
        return;
    }
    const int place = first >= 0 ? first : builder->models.n;
    struct dalcs_model *model = &builder->models.model[place];
    *model = (struct dalcs_model){.kind = DALCS_MODEL_WRONG, .name = name, .card = card};
    if (first < 0 && dalcs_names_add(&builder->models.names, name->text, place) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->models.n += first < 0 ? 1 : 0;
    if (!dalcs_reader_name(&reader, "the type of the model", &type)) {
        return;
    }
    const struct type *known = find_type(type->text);
    model->type = type;
    if (known == NULL) {
        dalcs_builder_error(builder, type, hint_of_type(builder, type->text),
                            "there is no model type '%s'", type->text);
        return;
    }
    model->kind = known->kind;
    if (known->kind == DALCS_MODEL_PASSIVE) {
        read_passive(&reader, model);
    } else if (known->kind != DALCS_MODEL_OTHER && !read_parameters(&reader, model)) {
        model->kind = DALCS_MODEL_WRONG;
    }
}

void dalcs_model_check(struct dalcs_builder *builder) {
    for (int k = 0; k < builder->models.n; k++) {
        const struct dalcs_model *model = &builder->models.model[k];
        if (model->kind == DALCS_MODEL_OTHER && !model->was_refused) {
            dalcs_builder_warn(builder, model->type, NULL,
                               "%s models are not supported: '%s' is ignored",
                               find_type(model->type->text)->what, model->name->text);
        }
    }
}
