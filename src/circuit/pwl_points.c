/* pwl_points.c - the points of a PWL: from its card or a file, in ascending time, into a stimulus. */
#include "pwl_points.h"

#include "number_file.h"

#include <string.h>

enum { MOST_POINTS = 10000000 };

bool dalcs_pwl_add(struct dalcs_pwl_points *p, const struct dalcs_token *place, double t,
                   double v) {
    struct dalcs_builder *builder = p->reader->builder;
    if (p->n >= MOST_POINTS) {
        dalcs_builder_error(builder, place, NULL, "a PWL of more than %d points", MOST_POINTS);
        return false;
    }
    if (p->n > 0 && t < p->t[p->n - 1]) {
        dalcs_builder_error(builder, place, "times must ascend; two equal times are a jump",
                            "PWL time %g s is before the one ahead of it, %g s", t, p->t[p->n - 1]);
        return false;
    }
    if (dalcs_grow(&p->t, &p->t_capacity, p->n + 1, sizeof *p->t) != DALCS_OK ||
        dalcs_grow(&p->v, &p->v_capacity, p->n + 1, sizeof *p->v) != DALCS_OK) {
        builder->out_of_memory = true;
        return false;
    }
    p->t[p->n] = t;
    p->v[p->n++] = v;
    return true;
}

static bool read_text(struct dalcs_pwl_points *p, const struct dalcs_token *place,
                      struct dalcs_number_file *file) {
    struct dalcs_builder *builder = p->reader->builder;
    double t;
    double v;
    const size_t before = p->n;
    while (dalcs_number_file_next(file, &t)) {
        if (!dalcs_number_file_next(file, &v)) {
            if (file->wrong != NULL) {
                break;
            }
            dalcs_builder_error(builder, place, "each line is a time and a value",
                                "%s:%d: the last time has no value", file->path, file->line);
            return false;
        }
        if (p->n > before && p->from + t * p->time_scale < p->t[p->n - 1]) {
            dalcs_builder_error(builder, place, "times must ascend; two equal times are a jump",
                                "%s:%d: time %g s is before the one ahead of it", file->path,
                                file->line, t);
            return false;
        }
        if (!dalcs_pwl_add(p, place, p->from + t * p->time_scale, v * p->value_scale)) {
            return false;
        }
    }
    if (!dalcs_number_file_is_read(builder, place, file, "each line is a time and a value")) {
        return false;
    }
    if (p->n == before) {
        dalcs_builder_error(builder, place, NULL, "there are no points in %s", file->path);
        return false;
    }
    return true;
}

bool dalcs_pwl_read_file(struct dalcs_pwl_points *p) {
    struct dalcs_builder *builder = p->reader->builder;
    const struct dalcs_token *place = dalcs_reader_peek(p->reader, 0);
    struct dalcs_number_file file;
    if (place == NULL || (place->kind != DALCS_TOKEN_WORD && place->kind != DALCS_TOKEN_STRING)) {
        dalcs_reader_missing(p->reader, "the name of a file");
        return false;
    }
    p->reader->at++;
    if (!dalcs_number_file_open(builder, place, "points", &file)) {
        return false;
    }
    const bool ok = read_text(p, place, &file);
    dalcs_number_file_close(&file);
    return ok;
}

bool dalcs_pwl_keep(struct dalcs_pwl_points *p, struct dalcs_stimulus *stimulus) {
    struct dalcs_arena *arena = &p->reader->builder->circuit->arena;
    double *t = dalcs_arena_alloc(arena, p->n, sizeof *t);
    double *v = dalcs_arena_alloc(arena, p->n, sizeof *v);
    if (t == NULL || v == NULL) {
        p->reader->builder->out_of_memory = true;
        return false;
    }
    for (size_t k = 0; k < p->n; k++) {
        t[k] = p->t[k] + p->delay;
        v[k] = p->v[k];
    }
    stimulus->kind = DALCS_STIMULUS_PWL;
    stimulus->u.pwl.n = (int)p->n;
    stimulus->u.pwl.t = t;
    stimulus->u.pwl.v = v;
    stimulus->u.pwl.repeats = p->repeat != NULL || p->has_forever;
    stimulus->u.pwl.repeat_from = stimulus->u.pwl.repeats ? p->repeat_from + p->delay : 0;
    return true;
}
