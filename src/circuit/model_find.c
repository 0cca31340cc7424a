/* model_find.c - the model that an element names. */
#include "model_cards.h"
#include "reader.h"

#include <string.h>

/* R or RES, C or CAP, L or IND. */
static bool is_type_of(const struct dalcs_model *model, char letter) {
    const char first = model->type->text[0];
    return first == letter || (letter == 'l' && first == 'i');
}

bool dalcs_model_take_passive(struct dalcs_reader *reader, char letter,
                              const struct dalcs_model **taken) {
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    if (name == NULL || name->kind != DALCS_TOKEN_WORD ||
        (next != NULL && next->kind == DALCS_TOKEN_EQUAL)) {
        return true;
    }
    const int index = dalcs_names_find(&reader->builder->models.names, name->text);
    if (index < 0 || reader->builder->models.model[index].kind != DALCS_MODEL_PASSIVE ||
        !is_type_of(&reader->builder->models.model[index], letter)) {
        return true;
    }
    const struct dalcs_model *model = &reader->builder->models.model[index];
    reader->at++;
    if (model->beyond != NULL) {
        dalcs_builder_error(
            reader->builder, name, "write the value on the card and leave out the model",
            "model '%s' has %s=, which is not supported", name->text, model->beyond->text);
    }
    *taken = model;
    return model->beyond == NULL;
}

/* The type that a card must have. */
static const char *wanted_type(enum dalcs_model_kind kind) {
    return kind == DALCS_MODEL_DIODE ? "D" : kind == DALCS_MODEL_SWITCH ? "SW" : "CSW";
}

/* A model that nothing defines, from the table of diodes, or D; -1: it is neither. */
static int add_part(struct dalcs_builder *builder, const struct dalcs_token *name) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_model *model = &builder->models.model[builder->models.n];
    const char *own = dalcs_arena_copy(&circuit->arena, name->text, strlen(name->text));
    struct dalcs_diode_card diode;
    struct dalcs_diode_model *lines = &circuit->models.of_diode[circuit->models.n_diodes];
    if (own == NULL ||
        !(strcmp(own, "d") == 0 ? dalcs_diode_take_default(builder, name, &diode, lines)
                                : dalcs_diode_take_part(builder, name, &diode, lines))) {
        builder->out_of_memory = builder->out_of_memory || own == NULL;
        return -1;
    }
    *model = (struct dalcs_model){.kind = DALCS_MODEL_DIODE,
                                  .index = circuit->models.n_diodes++,
                                  .name = name,
                                  .type = name,
                                  .diode = diode};
    lines->name = own;
    if (dalcs_names_add(&builder->models.names, own, builder->models.n) != DALCS_OK) {
        builder->out_of_memory = true;
        return -1;
    }
    return builder->models.n++;
}

int dalcs_model_find_switch(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const int index = dalcs_names_find(&builder->models.names, name->text);
    const bool by_current =
        index >= 0 && builder->models.model[index].kind == DALCS_MODEL_CURRENT_SWITCH;
    return dalcs_model_find(builder, name,
                            by_current ? DALCS_MODEL_CURRENT_SWITCH : DALCS_MODEL_SWITCH);
}

int dalcs_model_find(struct dalcs_builder *builder, const struct dalcs_token *name,
                     enum dalcs_model_kind kind) {
    int index = dalcs_names_find(&builder->models.names, name->text);
    if (index < 0 && kind == DALCS_MODEL_DIODE && builder->models.n < builder->models.capacity &&
        (builder->hidden & DALCS_HIDDEN_MODELS) == 0) {
        index = add_part(builder, name);
    }
    if (index < 0) {
        builder->failed = true;
        if ((builder->hidden & DALCS_HIDDEN_MODELS) == 0) {
            dalcs_builder_error(
                builder, name,
                builder->netlist->missing_library != NULL
                    ? dalcs_builder_hint(builder, "it may be in '%s', which was not found",
                                         builder->netlist->missing_library)
                : builder->models.n > 0
                    ? dalcs_builder_suggest(builder, &builder->models.names, name->text, "models")
                    : dalcs_builder_hint(builder, "add a line: .model %s %s", name->text,
                                         kind == DALCS_MODEL_DIODE    ? "D"
                                         : kind == DALCS_MODEL_SWITCH ? "SW(Vt=0.5)"
                                                                      : "CSW(It=0.5)"),
                "there is no model '%s'", name->text);
        }
        return -1;
    }
    struct dalcs_model *model = &builder->models.model[index];
    if (model->kind == DALCS_MODEL_WRONG) {
        return -1;
    }
    if (model->kind != kind) {
        model->was_refused = true;
        dalcs_builder_error(builder, name, NULL, "model '%s' is of type %s, here %s is wanted",
                            name->text, model->type->text, wanted_type(kind));
        return -1;
    }
    return model->index;
}
