/* logic_parameters.c - what stands behind the function of one of LTspice's A elements: parameter=value, and flags. */
#include "logic_parts.h"
#include "model_cards.h"
#include "reader.h"

#include <string.h>

/* The accuracies of LTspice's own steps, and a temperature that nothing here has. */
static bool is_without_effect(const struct dalcs_token *name) {
    static const char *const names[] = {"tripdt", "tripdv", "ttol", "temp"};
    return dalcs_builder_is_one_of(name->text, names, sizeof names / sizeof names[0]);
}

/* Noise, how an OTA powers up, and the width of its clamps' knees, which are sharp here. */
static bool is_noise(const struct dalcs_token *name) {
    static const char *const names[] = {"en",    "enk",   "in",        "ink",     "incm",
                                        "incmk", "noisy", "noiseless", "epsilon", "powerup"};
    return dalcs_builder_is_one_of(name->text, names, sizeof names / sizeof names[0]);
}

static struct dalcs_parameter *find(const struct dalcs_logic_parameters *of, const char *name) {
    for (int k = 0; k < of->n; k++) {
        if (of->p[k].name != NULL && strcmp(of->p[k].name, name) == 0) {
            return &of->p[k];
        }
    }
    return NULL;
}

/* parameter=value, or "vhigh 5" without the sign between them, which LTspice reads, too; NULL: neither. */
static const struct dalcs_token *take_name(struct dalcs_reader *reader,
                                           const struct dalcs_logic_parameters *of) {
    const struct dalcs_token *signed_name = dalcs_reader_take_parameter(reader);
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *value = dalcs_reader_peek(reader, 1);
    if (signed_name != NULL || name->kind != DALCS_TOKEN_WORD || value == NULL ||
        !dalcs_reader_is_number(value) ||
        (find(of, name->text) == NULL && !is_without_effect(name))) {
        return signed_name;
    }
    reader->at++;
    return name;
}

/* A word alone: a flag that is set. */
static bool take_flag(struct dalcs_reader *reader, const struct dalcs_logic_parameters *of) {
    static const char *const flags[] = {"linear", "asym"};
    const struct dalcs_token *word = dalcs_reader_peek(reader, 0);
    struct dalcs_parameter *p =
        word->kind == DALCS_TOKEN_WORD && dalcs_builder_is_one_of(word->text, flags, 2)
            ? find(of, word->text)
            : NULL;
    if (p == NULL) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    p->place = word;
    p->value = 1;
    reader->at++;
    return true;
}

/* A value that may be a formula without braces, as `en=.85n+freq/(8k*freq)`: up to the next blank outside of brackets. */
static bool skip_formula(struct dalcs_reader *reader) {
    const struct dalcs_token *before;
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    int depth = 0;
    if (next == NULL || next->kind == DALCS_TOKEN_EQUAL || next->kind == DALCS_TOKEN_CLOSE) {
        return dalcs_reader_skip_value(reader); /* which says what is missing */
    }
    do {
        depth += next->kind == DALCS_TOKEN_OPEN ? 1 : next->kind == DALCS_TOKEN_CLOSE ? -1 : 0;
        reader->at++;
        before = next;
        next = dalcs_reader_peek(reader, 0);
    } while (next != NULL && (depth > 0 || (next->line == before->line &&
                                            next->offset == before->offset + (int)before->length)));
    return true;
}

static bool take_other(struct dalcs_reader *reader, const struct dalcs_logic_parameters *of,
                       const struct dalcs_token *name) {
    if (of->has_noise && is_noise(name)) {
        dalcs_builder_note(reader->builder, name, NULL,
                           "'%s' has no meaning here and is ignored: noise and the powering up "
                           "of an OTA are not simulated",
                           name->text);
        return skip_formula(reader);
    }
    if (!is_without_effect(name)) {
        dalcs_builder_error(reader->builder, name, reader->usage, "%s has no parameter '%s' here",
                            of->what, name->text);
        return false;
    }
    return dalcs_reader_skip_value(reader);
}

bool dalcs_logic_read_parameters(struct dalcs_reader *reader,
                                 const struct dalcs_logic_parameters *of) {
    bool ok = true;
    while (ok && !dalcs_reader_at_end(reader)) {
        const struct dalcs_token *name = take_name(reader, of);
        struct dalcs_parameter *p = name != NULL ? find(of, name->text) : NULL;
        if (name == NULL) {
            ok = take_flag(reader, of);
        } else if (p == NULL) {
            ok = take_other(reader, of, name);
        } else {
            p->place = name;
            ok = dalcs_reader_number(reader, p->quantity, "a value", &p->value);
        }
    }
    return ok;
}

void dalcs_logic_ignore_threshold(const struct dalcs_reader *reader,
                                  const struct dalcs_parameter *p, const char *function) {
    if (p->place != NULL) {
        dalcs_builder_warn(reader->builder, p->place,
                           "Ref= is the threshold; SCHMTBUF and SCHMTINV have a hysteresis",
                           "'%s' has no meaning for %s and is ignored", p->name, function);
    }
}

bool dalcs_logic_check_signs(const struct dalcs_reader *reader,
                             const struct dalcs_logic_parameters *of) {
    for (int k = 0; k < of->n; k++) {
        const struct dalcs_parameter *p = &of->p[k];
        if (p->place != NULL && p->quantity != DALCS_VOLTAGE && !(p->value >= 0)) {
            dalcs_builder_error(reader->builder, p->place, reader->usage, "'%s' cannot be negative",
                                p->name);
            return false;
        }
    }
    return true;
}
