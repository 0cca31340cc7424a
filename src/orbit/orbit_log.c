/* orbit_log.c - segments of a run joined to spans of one mode, and their ends. */
#include "orbit_log.h"

#include "orbit_commands.h"
#include "orbit_rest.h"
#include "quads.h"
#include "recurrence.h"
#include "segments_observer.h"
#include "smooth_newton.h"
#include "step_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Spans --------------------------------------------------------------------------------------- */

/* What lies before the end of the span is known. */
static enum dalcs_status meet_end(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span) {
    const struct dalcs_radau_part *part = p->rates.part;
    const size_t n_columns = (size_t)dalcs_system_n_columns(part->component->system);
    span->df = dalcs_arena_alloc(&p->log->arena, (size_t)p->rates.n_x, sizeof(double));
    span->dy = dalcs_arena_alloc(&p->log->arena, n_columns, sizeof(double));
    if (span->df == NULL || span->dy == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_step_values(part, part->segment.end, p->work_y);
    dalcs_orbit_rates_of(&p->rates, p->work_y, part->segment.end * part->segment.h, span->df);
    memcpy(span->dy, p->work_y, n_columns * sizeof(double));
    p->pending = true;
    return DALCS_OK;
}

/* But for outputs of gates. */
static void leap_bystanders(const struct dalcs_orbit_part *p, struct dalcs_orbit_span *span) {
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    for (int k = 0; k < b->n; k++) {
        for (int i = 1; i < s->n_inputs; i++) {
            const int pin = dalcs_logic_pin_of(p->log->gates->memory, s->stimulus[i]);
            span->dy[b->column[k]] -= pin >= 0
                                          ? b->gain[(size_t)k * (size_t)s->n_inputs + (size_t)i] *
                                                span->gates->pin[pin].leap
                                          : 0.0;
        }
    }
}

/* And what lies behind it. Sources alone decide bystanders, which do not jump for an event. */
static void pass_end(struct dalcs_orbit_part *p, const double *f, const double *y) {
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    struct dalcs_orbit_span *span = &p->span[p->n - 1];
    for (int x = 0; x < p->rates.n_x; x++) {
        span->df[x] -= f[x];
    }
    for (int c = 0; c < dalcs_system_n_columns(part->component->system); c++) {
        span->dy[c] -= y[c];
    }
    for (int k = 0; k < b->n; k++) {
        span->dy[b->column[k]] = 0.0;
    }
    if (span->gates != NULL && span->gates->decides) {
        leap_bystanders(p, span);
    }
    p->pending = false;
}

static enum dalcs_status find_begin(struct dalcs_orbit_part *p, double *f, double *y) {
    const struct dalcs_radau_part *part = p->rates.part;
    memcpy(y, part->segment.out, (size_t)part->stages.layout.stride * sizeof(double));
    dalcs_orbit_rates_of(&p->rates, y, 0.0, f);
    return DALCS_OK;
}

static struct dalcs_orbit_span *add_span(struct dalcs_orbit_part *p, const uint64_t *mode) {
    const size_t words = (size_t)p->rates.part->stages.n_words;
    if (dalcs_grow(&p->span, &p->capacity, (size_t)p->n + 1, sizeof *p->span) != DALCS_OK) {
        return NULL;
    }
    struct dalcs_orbit_span *span = &p->span[p->n];
    *span = (struct dalcs_orbit_span){.row = -1};
    span->mode = dalcs_arena_alloc(&p->log->arena, words, sizeof(*mode));
    if (span->mode == NULL) {
        return NULL;
    }
    memcpy(span->mode, mode, words * sizeof(*mode));
    p->n++;
    return span;
}

/* Where there are smooth sources each segment is a span, with what they read in it. */
static enum dalcs_status note_arguments(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span) {
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    span->h = part->segment.h;
    span->argument = dalcs_arena_alloc(&p->log->arena, (size_t)l->n_nodes * (size_t)s->n_smooth,
                                       sizeof *span->argument);
    if (span->argument == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int node = 0; node < l->n_nodes; node++) {
        dalcs_smooth_arguments(s, part->segment.out + node * l->stride,
                               span->argument + node * s->n_smooth);
    }
    return DALCS_OK;
}

static bool goes_on(const struct dalcs_orbit_part *p, const uint64_t *mode) {
    const struct dalcs_orbit_span *last =
        p->n > 0 && !p->jumped && p->rates.part->smooth == NULL ? &p->span[p->n - 1] : NULL;
    return last != NULL && last->df == NULL && last->gates == NULL &&
           dalcs_mode_is(last->mode, mode, p->rates.part->stages.n_words);
}

/* What gates may do where the segment ends. */
static enum dalcs_status end_at_gates(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span) {
    const struct dalcs_radau_part *part = p->rates.part;
    span->gates = dalcs_arena_alloc(&p->log->arena, 1, sizeof *span->gates);
    return span->gates != NULL
               ? dalcs_orbit_instant_begin(p->log->gates, span->gates, part, part->segment.t_end)
               : DALCS_E_NOMEM;
}

/* The jump that the span begins with; f: f+ of the event that moves it, NULL if none does. */
static enum dalcs_status begin_with_jump(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span,
                                         const double *f) {
    const size_t words = (size_t)p->rates.part->stages.n_words;
    const size_t n_x = (size_t)p->rates.n_x;
    span->jump = dalcs_arena_alloc(&p->log->arena, words, sizeof(*span->jump));
    span->behind = f != NULL ? dalcs_arena_alloc(&p->log->arena, n_x, sizeof(double)) : NULL;
    if (span->jump == NULL || (f != NULL && span->behind == NULL)) {
        return DALCS_E_NOMEM;
    }
    memcpy(span->jump, p->jump_mode, words * sizeof(*span->jump));
    if (f != NULL) {
        memcpy(span->behind, f, n_x * sizeof(double));
    }
    p->jumped = false;
    return DALCS_OK;
}

static enum dalcs_status take_segment(struct dalcs_orbit_part *p) {
    const struct dalcs_radau_part *part = p->rates.part;
    const uint64_t *mode = part->component->osnsp.mode;
    const bool moves_jump = p->pending;
    p->jumped = p->jumped && !dalcs_mode_is(p->jump_mode, mode, part->stages.n_words);
    if (p->n == 0) {
        DALCS_TRY(find_begin(p, p->f, p->y));
    } else if (p->pending) {
        DALCS_TRY(find_begin(p, p->work_f, p->work_y));
        pass_end(p, p->work_f, p->work_y);
    }
    bool goes = goes_on(p, mode);
    struct dalcs_orbit_span *span = goes ? &p->span[p->n - 1] : add_span(p, mode);
    if (span == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(p->jumped ? begin_with_jump(p, span, moves_jump ? p->work_f : NULL) : DALCS_OK);
    span->from = goes ? span->from : part->segment.t;
    span->to = part->segment.t_end;
    if (part->smooth != NULL) {
        DALCS_TRY(note_arguments(p, span));
    }
    p->log->is_exact = p->log->is_exact && !part->segment.by_euler;
    DALCS_TRY(part->segment.by_euler ? DALCS_OK : dalcs_orbit_rest_note(p, span));
    if (p->log->gates != NULL && part->segment.why != DALCS_END_OF_STEP) {
        DALCS_TRY(end_at_gates(p, span));
    }
    if (!part->segment.by_euler && part->guards.n_crossed > 0) {
        int row = dalcs_orbit_guard_row(part, part->guards.crossed[0]);
        span->rate = dalcs_orbit_guard_rate(part, row);
        span->row = span->rate != 0.0 ? row : -1;
        p->log->is_exact = p->log->is_exact && span->row >= 0; /* it only touches its threshold */
    } else {
        dalcs_orbit_find_commands(p, span);
    }
    bool moves =
        span->row >= 0 || span->moved[0] != 0.0 || span->moved[1] != 0.0 || span->gates != NULL;
    return moves ? meet_end(p, span) : DALCS_OK;
}

static void segment(void *user, const struct dalcs_radau_part *present, const double *start) {
    struct dalcs_orbit_log *log = user;
    struct dalcs_orbit_part *p = &log->part[present->index];
    (void)start;
    if (log->status < DALCS_OK || present->kind != DALCS_PART_STEPPED) {
        return;
    }
    dalcs_recurrence_complete(&log->radau->part[present->index]);
    enum dalcs_status status = take_segment(p);
    if (status == DALCS_OK && log->is_recorded) {
        status = dalcs_orbit_record_take(&p->record, present, &log->arena);
    }
    log->status = status < DALCS_OK ? status : log->status;
}

/* The mode of its impulses, that of the first micro-step, counts where it is not that of the segment behind it. */
static void jump(void *user, const struct dalcs_euler_jump *told) {
    struct dalcs_orbit_log *log = user;
    struct dalcs_orbit_part *p = &log->part[told->system];
    const struct dalcs_radau_part *part = p->rates.part;
    if (log->status < DALCS_OK || part->kind != DALCS_PART_STEPPED) {
        return;
    }
    const uint64_t *mode = part->work.mode_first;
    log->is_exact =
        log->is_exact && (!p->jumped || dalcs_mode_is(p->jump_mode, mode, part->stages.n_words));
    memcpy(p->jump_mode, mode, (size_t)part->stages.n_words * sizeof(*mode));
    p->jumped = true;
}

static void try_by_euler(void *user, int k) {
    struct dalcs_orbit_log *log = user;
    log->is_exact = false;
    (void)k;
}

struct dalcs_observer dalcs_orbit_log_observer(struct dalcs_orbit_log *log) {
    struct dalcs_observer observer = dalcs_segments_observer(log, segment);
    observer.jump = jump;
    observer.try_by_euler = try_by_euler;
    return observer;
}

/* ---- The end ------------------------------------------------------------------------------------- */

static enum dalcs_status close_part(struct dalcs_orbit_part *p, double T) {
    const struct dalcs_radau_part *part = p->rates.part;
    if (p->n == 0) { /* nothing steps, nothing changes sides */
        struct dalcs_orbit_span *span = add_span(p, part->component->osnsp.mode);
        if (span == NULL) {
            return DALCS_E_NOMEM;
        }
        span->to = T;
        return DALCS_OK;
    }
    p->span[p->n - 1].to = T;
    if (p->log->gates != NULL) {
        DALCS_TRY(dalcs_orbit_gates_close(p->log->gates));
    }
    if (!p->pending) {
        DALCS_TRY(dalcs_orbit_find_last(p) ? meet_end(p, &p->span[p->n - 1]) : DALCS_OK);
    }
    if (p->pending) {
        pass_end(p, p->f, p->y);
    }
    return dalcs_orbit_rest_find(p, T);
}

enum dalcs_status dalcs_orbit_log_close(struct dalcs_orbit_log *log, double T) {
    for (int k = 0; k < log->n_parts && log->status == DALCS_OK; k++) {
        log->status = close_part(&log->part[k], T);
    }
    return log->status;
}

/* ---- Gates --------------------------------------------------------------------------------------- */

/* Where the last span ends, or at the start, or where nothing but gates is concerned. */
static enum dalcs_status seen(void *user, const struct dalcs_logic_instant *instant) {
    struct dalcs_orbit_log *log = user;
    const struct dalcs_orbit_part *p = &log->part[0];
    const struct dalcs_orbit_span *last = p->n > 0 ? &p->span[p->n - 1] : NULL;
    struct dalcs_orbit_instant *at = last == NULL ? &log->gates->first
                                     : last->gates != NULL && last->to == instant->t ? last->gates
                                                                                     : NULL;
    return dalcs_orbit_gates_note(log->gates, at, instant);
}

enum dalcs_status dalcs_orbit_log_watch(struct dalcs_orbit_log *log, struct dalcs_logic_run *logic,
                                        const struct dalcs_logic_memory *memory) {
    if (logic->circuit == NULL) {
        return DALCS_OK;
    }
    log->gates = dalcs_arena_alloc(&log->arena, 1, sizeof *log->gates);
    if (log->gates == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_orbit_gates_setup(log->gates, &log->arena, log->radau, logic, memory));
    return dalcs_logic_watch_start(&log->gates->watch, logic, memory, log, seen);
}

/* ---- Set up -------------------------------------------------------------------------------------- */

static enum dalcs_status part_setup(struct dalcs_orbit_log *log, struct dalcs_orbit_part *p,
                                    const struct dalcs_radau_part *part) {
    const size_t n_x = (size_t)part->component->system->n_x;
    const size_t stride = (size_t)dalcs_quads_of(part->stages.layout.stride);
    p->log = log;
    p->f = dalcs_arena_alloc(&log->arena, n_x, sizeof(double));
    p->work_f = dalcs_arena_alloc(&log->arena, n_x, sizeof(double));
    p->y = dalcs_arena_alloc(&log->arena, stride, sizeof(double));
    p->work_y = dalcs_arena_alloc(&log->arena, stride, sizeof(double));
    p->jump_mode =
        dalcs_arena_alloc(&log->arena, (size_t)part->stages.n_words + 1, sizeof(*p->jump_mode));
    if (p->f == NULL || p->work_f == NULL || p->y == NULL || p->work_y == NULL ||
        p->jump_mode == NULL) {
        return DALCS_E_NOMEM;
    }
    return dalcs_orbit_rates_setup(&p->rates, &log->arena, part);
}

enum dalcs_status dalcs_orbit_log_setup(struct dalcs_orbit_log *log, struct dalcs_radau *radau,
                                        const struct dalcs_orbit_sources *sources) {
    *log = (struct dalcs_orbit_log){
        .radau = radau, .n_parts = radau->n_parts, .sources = *sources, .is_exact = true};
    log->part = dalcs_arena_alloc(&log->arena, (size_t)radau->n_parts, sizeof(*log->part));
    enum dalcs_status status = log->part != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int k = 0; k < radau->n_parts && status == DALCS_OK; k++) {
        status = part_setup(log, &log->part[k], &radau->part[k]);
    }
    if (status != DALCS_OK) {
        dalcs_orbit_log_finish(log);
    }
    return status;
}

void dalcs_orbit_log_finish(struct dalcs_orbit_log *log) {
    for (int k = 0; log->part != NULL && k < log->n_parts; k++) {
        free(log->part[k].span);
        dalcs_orbit_rest_finish(&log->part[k]);
        dalcs_orbit_record_finish(&log->part[k].record);
    }
    if (log->gates != NULL) {
        dalcs_logic_watch_finish(&log->gates->watch);
        free(log->gates->cause);
    }
    dalcs_arena_finish(&log->arena);
    *log = (struct dalcs_orbit_log){0};
}
