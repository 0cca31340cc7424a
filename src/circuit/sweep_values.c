/* sweep_values.c - over which values a sweep goes: ranges, lists, files. */
#include "sweep_card.h"

#include "number_file.h"

#include <stdlib.h>
#include <string.h>

static enum dalcs_quantity quantity_of(const struct dalcs_builder *builder,
                                       const struct dalcs_sweep *sweep) {
    if (sweep->device < 0) {
        return DALCS_PLAIN;
    }
    switch (builder->circuit->device[sweep->device].letter) {
    case 'r':
        return DALCS_OHM;
    case 'c':
        return DALCS_FARAD;
    case 'v':
        return DALCS_VOLTAGE;
    case 'i':
        return DALCS_CURRENT;
    default:
        return DALCS_PLAIN;
    }
}

bool dalcs_sweep_count_values(struct dalcs_builder *builder, const struct dalcs_token *const *place,
                              const char *usage, struct dalcs_sweep *sweep) {
    if (sweep->spacing == DALCS_LINEAR && sweep->step == 0.0 && sweep->start != sweep->stop) {
        dalcs_builder_error(builder, place[2], usage, "a step of 0 never reaches %g", sweep->stop);
        return false;
    }
    if (sweep->spacing != DALCS_LINEAR) {
        if (!(sweep->start > 0.0) || !(sweep->stop >= sweep->start)) {
            dalcs_builder_error(builder, sweep->start > 0.0 ? place[1] : place[0], usage,
                                "decades and octaves go from a positive value up to a larger one");
            return false;
        }
        if (!(sweep->step >= 1.0)) {
            dalcs_builder_error(builder, place[2], usage, "there must be at least 1 value in each");
            return false;
        }
    }
    sweep->n = dalcs_sweep_count(sweep->spacing, sweep->start, sweep->stop, sweep->step);
    if (sweep->n == 0) { /* PSpice goes either way by a step above 0 */
        sweep->step = -sweep->step;
        dalcs_builder_warn(builder, place[2], dalcs_builder_hint(builder, "write %g", sweep->step),
                           "a step of %g leads away from %g to %g: %g is taken", -sweep->step,
                           sweep->start, sweep->stop, sweep->step);
        sweep->n = dalcs_sweep_count(sweep->spacing, sweep->start, sweep->stop, sweep->step);
    }
    if (sweep->n < 0) {
        dalcs_builder_error(builder, place[2], NULL, "these are more than %d values",
                            (int)DALCS_SWEEP_MOST);
        return false;
    }
    return true;
}

bool dalcs_sweep_read_range(struct dalcs_reader *reader, const char *usage,
                            struct dalcs_sweep *sweep) {
    static const char *const what[] = {"a start", "a stop", "a step"};
    const enum dalcs_quantity quantity = quantity_of(reader->builder, sweep);
    const bool counts = sweep->spacing != DALCS_LINEAR;
    double *value[] = {&sweep->start, &sweep->stop, &sweep->step};
    const struct dalcs_token *place[3];
    for (int k = 0; k < 3; k++) {
        place[k] = dalcs_reader_peek(reader, 0);
        if (!dalcs_reader_list_number(reader, k == 2 && counts ? DALCS_PLAIN : quantity, what[k],
                                      value[k])) {
            return false;
        }
    }
    return dalcs_sweep_count_values(reader->builder, place, usage, sweep);
}

bool dalcs_sweep_read_list(struct dalcs_reader *reader, struct dalcs_sweep *sweep) {
    const enum dalcs_quantity quantity = quantity_of(reader->builder, sweep);
    const size_t room = (size_t)(reader->card->n - reader->at);
    double *list = dalcs_arena_alloc(&reader->builder->circuit->arena, room, sizeof *list);
    if (list == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    do {
        if (!dalcs_reader_list_number(reader, quantity, "a value", &list[sweep->n])) {
            return false;
        }
        sweep->n++;
    } while (!dalcs_reader_at_end(reader));
    sweep->spacing = DALCS_LISTED;
    sweep->list = list;
    return true;
}

bool dalcs_sweep_read_file(struct dalcs_reader *reader, struct dalcs_sweep *sweep) {
    struct dalcs_builder *builder = reader->builder;
    struct dalcs_number_file file;
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    if (name == NULL || (name->kind != DALCS_TOKEN_WORD && name->kind != DALCS_TOKEN_STRING)) {
        dalcs_reader_missing(reader, "the name of a file");
        return false;
    }
    reader->at++;
    if (!dalcs_number_file_open(builder, name, "values", &file)) {
        return false;
    }
    double *list = NULL;
    size_t capacity = 0;
    double value;
    enum dalcs_status status = DALCS_OK;
    while (status == DALCS_OK && sweep->n <= DALCS_SWEEP_MOST &&
           dalcs_number_file_next(&file, &value)) {
        status = dalcs_grow(&list, &capacity, (size_t)sweep->n + 1, sizeof *list);
        if (status == DALCS_OK) {
            list[sweep->n++] = value;
        }
    }
    bool ok = status == DALCS_OK && dalcs_number_file_is_read(builder, name, &file,
                                                              "the values, with blanks or lines "
                                                              "between them");
    if (ok && sweep->n == 0) {
        dalcs_builder_error(builder, name, NULL, "there are no values in %s", file.path);
        ok = false;
    }
    double *kept =
        ok ? dalcs_arena_alloc(&builder->circuit->arena, (size_t)sweep->n, sizeof *kept) : NULL;
    builder->out_of_memory = builder->out_of_memory || status != DALCS_OK || (ok && kept == NULL);
    if (kept != NULL) {
        memcpy(kept, list, (size_t)sweep->n * sizeof *kept);
    }
    free(list);
    dalcs_number_file_close(&file);
    sweep->spacing = DALCS_LISTED;
    sweep->list = kept;
    return kept != NULL;
}

bool dalcs_sweep_take_spacing(struct dalcs_reader *reader, enum dalcs_spacing *spacing) {
    if (dalcs_reader_take_word(reader, "lin")) {
        *spacing = DALCS_LINEAR;
    } else if (dalcs_reader_take_word(reader, "dec")) {
        *spacing = DALCS_DECADES;
    } else if (dalcs_reader_take_word(reader, "oct")) {
        *spacing = DALCS_OCTAVES;
    } else {
        return false;
    }
    return true;
}
