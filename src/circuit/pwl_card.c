/* pwl_card.c - PWL on a source's card: points, repetition, scales, and points in a file.
 *
 *   ngspice    PWL(t v t v ...) [r=time] [td=time]: from r to the last point again and again
 *   LTspice    PWL(t v +dt v ...), REPEAT FOR n (...) ENDREPEAT, REPEAT FOREVER (...) ENDREPEAT,
 *              FILE=name, TIME_SCALE_FACTOR=x, VALUE_SCALE_FACTOR=x
 *
 * A block that is repeated counts its times from where it begins; blocks stand in blocks. What ends is written out; what
 * does not end is written out twice, and the second course repeats. */
#include "element_cards.h"
#include "number.h"
#include "pwl_points.h"
#include "reader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] = "PWL(time value time value ...) [r=time] [td=time]";

enum { DEEPEST = 4 };

/* Does a number follow? */
static bool more(const struct dalcs_reader *reader) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    return next != NULL && dalcs_reader_is_number(next);
}

/* +{formula}, which is a number by now. */
static bool is_relative(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    return token != NULL && strcmp(token->text, "+") == 0 && next != NULL &&
           next->kind == DALCS_TOKEN_NUMBER;
}

static bool read_point(struct dalcs_pwl_points *p) {
    struct dalcs_reader *reader = p->reader;
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    double t;
    double v;
    reader->at += is_relative(reader);
    if (!dalcs_reader_list_number(reader, DALCS_SECOND, "a time", &t)) {
        return false;
    }
    if (!more(reader)) {
        dalcs_builder_error(builder, token, USAGE, "this PWL time has no value");
        return false;
    }
    if (!dalcs_reader_list_number(reader, p->quantity, "a value", &v)) {
        return false;
    }
    if (p->has_forever) {
        dalcs_builder_error(builder, token, USAGE, "a point after a part that repeats forever");
        return false;
    }
    double origin = p->from;
    if (token->text[0] == '+') {
        origin = p->n > p->block ? p->t[p->n - 1] : p->from;
        if (!p->is_relative) {
            p->is_relative = true;
            dalcs_builder_note(builder, token, NULL,
                               "a time with '+' counts from the point before, as in LTspice");
        }
    }
    return dalcs_pwl_add(p, token, origin + t * p->time_scale, v * p->value_scale);
}

/* ---- Repetition ---------------------------------------------------------------------------- */

static bool read_items(struct dalcs_pwl_points *p, int depth);

/* Appends the block again, `later` after its first course. */
static bool repeat_block(struct dalcs_pwl_points *p, const struct dalcs_token *place, size_t n,
                         double later) {
    for (size_t k = 0; k < n; k++) {
        /* Rounding must not put the start of a course before the end of the last. */
        const double t = fmax(p->t[p->block + k] + later, p->t[p->n - 1]);
        if (!dalcs_pwl_add(p, place, t, p->v[p->block + k])) {
            return false;
        }
    }
    return true;
}

static void leave_block(struct dalcs_pwl_points *p, const struct dalcs_pwl_points *outer) {
    p->block = outer->is_in_block ? outer->block : p->n;
    p->from = outer->is_in_block ? outer->from : 0;
    p->is_in_block = outer->is_in_block;
}

/* After REPEAT. */
static bool read_repeat(struct dalcs_pwl_points *p, int depth) {
    struct dalcs_reader *reader = p->reader;
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *place = dalcs_reader_previous(reader);
    const bool is_forever = dalcs_reader_take_word(reader, "forever");
    double n = 2;
    if (!is_forever && !dalcs_reader_take_word(reader, "for")) {
        dalcs_reader_missing(reader, "FOR or FOREVER");
        return false;
    }
    if (!is_forever && !dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of times", &n)) {
        return false;
    }
    if (n < 1 || n != floor(n)) {
        dalcs_builder_error(builder, dalcs_reader_previous(reader), NULL,
                            "the number of repetitions must be 1, 2, 3, ...");
        return false;
    }
    /* Blocks stand in blocks: what is around this one goes on with its own origin behind it. */
    const struct dalcs_pwl_points outer = *p;
    if (is_forever && outer.is_in_block) {
        dalcs_builder_error(builder, place, "write REPEAT FOR n",
                            "a part that repeats forever cannot stand in one that repeats");
        return false;
    }
    p->block = p->n;
    p->from = p->n > 0 ? p->t[p->n - 1] : 0;
    p->is_in_block = true;
    if (!read_items(p, depth + 1)) {
        return false;
    }
    if (!dalcs_reader_take_word(reader, "endrepeat")) {
        dalcs_reader_missing(reader, "ENDREPEAT");
        return false;
    }
    const size_t points = p->n - p->block;
    const double length = points > 0 ? p->t[p->n - 1] - p->from : 0;
    if (length <= 0) {
        dalcs_builder_error(builder, place, NULL, "the part that repeats has no duration");
        return false;
    }
    for (double k = 1; k < n; k++) {
        if (!repeat_block(p, place, points, k * length)) {
            return false;
        }
    }
    p->has_forever = is_forever;
    p->repeat_from = p->from + length;
    leave_block(p, &outer);
    return true;
}

/* ---- The card ------------------------------------------------------------------------------ */

static bool read_scale(struct dalcs_pwl_points *p, double *scale) {
    if (!dalcs_reader_number(p->reader, DALCS_PLAIN, "a factor", scale)) {
        return false;
    }
    if (scale == &p->time_scale && *scale <= 0) {
        dalcs_builder_error(p->reader->builder, dalcs_reader_previous(p->reader), NULL,
                            "a factor of times must be positive");
        return false;
    }
    return true;
}

/* A parameter that belongs to a PWL; false with *ok when another or none comes next. */
static bool take_parameter(struct dalcs_pwl_points *p, bool *ok) {
    static const char *const names[] = {"file", "time_scale_factor", "value_scale_factor", "r",
                                        "td"};
    const struct dalcs_token *name = dalcs_reader_peek(p->reader, 0);
    const int at = p->reader->at;
    *ok = true;
    if (!dalcs_builder_is_one_of(name->text, names, sizeof names / sizeof names[0]) ||
        (dalcs_reader_take_parameter(p->reader) == NULL && strcmp(name->text, "file") != 0)) {
        p->reader->at = at;
        return false;
    }
    if (strcmp(name->text, "file") == 0) {
        p->reader->at += p->reader->at == at; /* Xyce has no = */
        *ok = dalcs_pwl_read_file(p);
    } else if (strcmp(name->text, "time_scale_factor") == 0) {
        *ok = read_scale(p, &p->time_scale);
    } else if (strcmp(name->text, "value_scale_factor") == 0) {
        *ok = read_scale(p, &p->value_scale);
    } else if (strcmp(name->text, "r") == 0) {
        p->repeat = name;
        *ok = dalcs_reader_number(p->reader, DALCS_SECOND, "a time", &p->repeat_from);
    } else {
        *ok = dalcs_reader_number(p->reader, DALCS_SECOND, "a time", &p->delay);
    }
    return true;
}

/* After an opening parenthesis. */
static bool read_group(struct dalcs_pwl_points *p, int depth) {
    struct dalcs_reader *reader = p->reader;
    const struct dalcs_token *open = dalcs_reader_previous(reader);
    if (!read_items(p, depth + 1)) {
        return false;
    }
    /* LTspice's own dialog leaves out the bracket behind an ENDREPEAT that ends the card. */
    p->is_closed = dalcs_reader_take(reader, DALCS_TOKEN_CLOSE) ||
                   (depth == 0 && p->has_forever && dalcs_reader_at_end(reader));
    if (!p->is_closed && dalcs_reader_at_end(reader)) {
        dalcs_builder_error(reader->builder, open, USAGE, "this parenthesis is never closed");
    } else if (!p->is_closed) {
        dalcs_reader_unexpected(reader);
    }
    return p->is_closed;
}

/* Reads up to the end or to the next keyword of the card; depth counts parentheses and blocks. */
static bool read_items(struct dalcs_pwl_points *p, int depth) {
    struct dalcs_reader *reader = p->reader;
    const struct dalcs_token *token;
    bool ok = true;
    while (ok && (token = dalcs_reader_peek(reader, 0)) != NULL) {
        if (depth < DEEPEST && dalcs_reader_take(reader, DALCS_TOKEN_OPEN)) {
            ok = read_group(p, depth);
        } else if ((dalcs_reader_is_number(token) || is_relative(reader)) &&
                   (depth > 0 || !p->is_closed)) {
            ok = read_point(p);
        } else if (depth < DEEPEST && dalcs_reader_take_word(reader, "repeat")) {
            ok = read_repeat(p, depth);
        } else if (!take_parameter(p, &ok)) {
            break;
        }
    }
    return ok;
}

/* r= must be one of the times, as in ngspice. */
static bool find_repeat(struct dalcs_pwl_points *p) {
    struct dalcs_builder *builder = p->reader->builder;
    const double from = p->repeat_from * p->time_scale;
    bool found = false;
    for (size_t k = 0; k + 1 < p->n && !found; k++) {
        found = p->t[k] == from && p->t[p->n - 1] > from;
    }
    if (p->has_forever || !found) {
        dalcs_builder_error(builder, p->repeat, USAGE,
                            "r= is the time of a point before the last one");
        return false;
    }
    p->repeat_from = from;
    return true;
}

bool dalcs_pwl_card_parse(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                          struct dalcs_stimulus *stimulus) {
    struct dalcs_pwl_points points = {
        .reader = reader, .quantity = quantity, .time_scale = 1, .value_scale = 1};
    const char *usage = reader->usage;
    reader->usage = USAGE;
    bool ok = read_items(&points, 0);
    if (ok && points.n == 0) {
        dalcs_reader_missing(reader, "a time");
        ok = false;
    }
    ok = ok && (points.repeat == NULL || find_repeat(&points)) && dalcs_pwl_keep(&points, stimulus);
    reader->usage = usage;
    free(points.t);
    free(points.v);
    return ok;
}
