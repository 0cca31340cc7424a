/* sweep_item.c - what a sweep changes: an element, a parameter, a parameter of a model, the temperature. */
#include "sweep_card.h"

#include <string.h>

const char *dalcs_sweep_keep_text(struct dalcs_builder *builder, const char *text) {
    const char *copy = dalcs_arena_copy(&builder->circuit->arena, text, strlen(text));
    builder->out_of_memory = builder->out_of_memory || copy == NULL;
    return copy;
}

static bool set_element(struct dalcs_builder *builder, const struct dalcs_token *token,
                        const char *letters, struct dalcs_sweep *sweep) {
    const int device = dalcs_builder_find_device(builder, token);
    if (device < 0) {
        return false;
    }
    const struct dalcs_device *d = &builder->circuit->device[device];
    if (strchr(letters, d->letter) == NULL) {
        dalcs_builder_error(builder, token, NULL, "'%s' is %s: it has no value to sweep here",
                            token->text, dalcs_builder_kind_text(d->kind));
        return false;
    }
    sweep->target = DALCS_SWEEP_ELEMENT;
    sweep->device = device;
    sweep->name = sweep->label = d->name;
    return true;
}

static bool set_parameter(struct dalcs_builder *builder, const struct dalcs_token *token,
                          struct dalcs_sweep *sweep) {
    if (!dalcs_deck_has_parameter(builder->deck, token->text)) {
        const char *nearest = dalcs_deck_nearest_parameter(builder->deck, token->text);
        dalcs_builder_error(
            builder, token,
            nearest != NULL ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest) : NULL,
            "there is no parameter '%s'", token->text);
        return false;
    }
    if (builder->deck->n_drawn == 0 && !dalcs_deck_uses_parameter(builder->deck, token->text)) {
        const char *nearest = dalcs_deck_nearest_parameter(builder->deck, token->text);
        const bool is_other = nearest != NULL && strcmp(nearest, token->text) != 0;
        dalcs_builder_warn(builder, token,
                           is_other ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest)
                                    : NULL,
                           "nothing uses the parameter '%s'", token->text);
    }
    sweep->target = DALCS_SWEEP_PARAMETER;
    sweep->name = sweep->label = dalcs_sweep_keep_text(builder, token->text);
    return true;
}

static void set_temperature(struct dalcs_builder *builder, const struct dalcs_token *token,
                            struct dalcs_sweep *sweep) {
    sweep->target = DALCS_SWEEP_TEMPERATURE;
    sweep->name = sweep->label = "temp";
    dalcs_builder_note(builder, token, NULL,
                       "R, L and C with tc1= or tc2=, and formulas with temp, follow the "
                       "temperature, and nothing else");
}

static bool set_model(struct dalcs_builder *builder, const struct dalcs_token *model,
                      const char *field, struct dalcs_sweep *sweep) {
    if (dalcs_names_find(&builder->models.names, model->text) < 0) {
        dalcs_builder_error(
            builder, model,
            dalcs_builder_suggest(builder, &builder->models.names, model->text, "models"),
            "there is no model '%s'", model->text);
        return false;
    }
    sweep->target = DALCS_SWEEP_MODEL;
    sweep->name = dalcs_sweep_keep_text(builder, model->text);
    sweep->field = dalcs_sweep_keep_text(builder, field);
    sweep->label = dalcs_arena_printf(&builder->circuit->arena, "%s(%s)", model->text, field);
    builder->out_of_memory = builder->out_of_memory || sweep->label == NULL;
    return true;
}

/* The next two or three tokens: `name ( parameter )`, after the type of the model if that is there; an element's name
 * is none. */
static bool is_model(const struct dalcs_reader *reader, int *at) {
    const struct dalcs_token *first = dalcs_reader_peek(reader, 0);
    const bool is_element = dalcs_names_find(&reader->builder->elements.devices, first->text) >= 0;
    for (*at = 0; *at <= (is_element ? 0 : 1); ++*at) {
        const struct dalcs_token *word = dalcs_reader_peek(reader, *at);
        const struct dalcs_token *open = dalcs_reader_peek(reader, *at + 1);
        const struct dalcs_token *field = dalcs_reader_peek(reader, *at + 2);
        const struct dalcs_token *close = dalcs_reader_peek(reader, *at + 3);
        if (close != NULL && word->kind == DALCS_TOKEN_WORD && open->kind == DALCS_TOKEN_OPEN &&
            field->kind == DALCS_TOKEN_WORD && close->kind == DALCS_TOKEN_CLOSE) {
            return true;
        }
    }
    return false;
}

/* The item of a .step, or the source of a .dc; letters: of the elements that may be swept. */
bool dalcs_sweep_read_item(struct dalcs_reader *reader, const char *letters,
                           struct dalcs_sweep *sweep) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    int at;
    sweep->device = -1;
    if (token == NULL || token->kind != DALCS_TOKEN_WORD) {
        dalcs_reader_missing(reader, "the item of the sweep");
        return false;
    }
    sweep->where = dalcs_builder_keep_location(builder, token);
    if (dalcs_reader_take_word(reader, "param") || dalcs_reader_take_word(reader, "param:")) {
        return dalcs_reader_name(reader, "the name of a parameter", &token) &&
               set_parameter(builder, token, sweep);
    }
    if (is_model(reader, &at)) {
        const struct dalcs_token *model = dalcs_reader_peek(reader, at);
        const struct dalcs_token *field = dalcs_reader_peek(reader, at + 2);
        reader->at += at + 4;
        return set_model(builder, model, field->text, sweep);
    }
    reader->at++;
    if (strcmp(token->text, "temp") == 0) {
        set_temperature(builder, token, sweep);
        return true;
    }
    if (dalcs_names_find(&builder->elements.devices, token->text) < 0 &&
        dalcs_deck_has_parameter(builder->deck, token->text)) {
        return set_parameter(builder, token, sweep);
    }
    return set_element(builder, token, letters, sweep);
}
