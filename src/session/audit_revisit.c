/* audit_revisit.c - a segment that has gone by, from what the auditor kept of it, in the place of the present one. */
#include "audit_reader.h"

#include "radau.h"

/* Its values are computed once more, into room[0], and those of the one before it into room[1]. */
struct audit_present {
    struct dalcs_part_segment segment;
    uint64_t *mode; /* [n_words] */
    double *last_out, last_time;
    double *room[2];
};

/* of[n_words], which may be none. */
static void take_mode(struct dalcs_radau_part *part, const uint64_t *of) {
    for (int k = 0; k < part->component->osnsp.n_words; k++) {
        part->component->osnsp.mode[k] = of[k];
    }
}

enum dalcs_status dalcs_audit_present_make(struct dalcs_audit_run *a, int part) {
    struct audit_present *p = dalcs_arena_alloc(&a->arena, 1, sizeof(*p));
    const size_t n_words = (size_t)a->euler->component[part].osnsp.n_words;
    const struct dalcs_stages *stages = &a->radau->part[part].stages;
    const size_t n = dalcs_stages_room(stages);
    uint64_t *mode = dalcs_arena_alloc(&a->arena, n_words, sizeof(*mode));
    double *room = dalcs_arena_alloc(&a->arena, 2 * n, sizeof(*room));
    if (p == NULL || mode == NULL || room == NULL) {
        return DALCS_E_NOMEM;
    }
    p->mode = mode;
    p->room[0] = room;
    p->room[1] = room + n;
    a->part[part].present = p;
    return DALCS_OK;
}

struct dalcs_audit_stretch *dalcs_audit_revisit(void *user, int index,
                                                const struct dalcs_audit_kept *before,
                                                const struct dalcs_audit_kept *present) {
    struct dalcs_audit_run *a = user;
    struct audit_members *m = &a->part[index];
    struct dalcs_radau_part *part = &a->radau->part[index];
    struct dalcs_part_segment *s = &part->segment;
    m->present->segment = *s;
    m->present->last_out = m->last.out;
    m->present->last_time = m->last.time;
    for (int k = 0; k < part->component->osnsp.n_words; k++) {
        m->present->mode[k] = part->component->osnsp.mode[k];
    }
    take_mode(part, m->last.mode);
    s->t = present->from;
    s->t_end = present->to;
    s->h = m->last.step;
    s->end = s->end_before = m->last.end;
    s->by_euler = s->is_coarse = false;
    s->in = present->input;
    s->out = m->present->room[0];
    s->late = m->held;
    s->brief = NULL;
    s->entry = m->held;
    s->in_before = before->input;
    s->out_before = m->present->room[1];
    s->late_before = m->held;
    m->last.out = s->out_before;
    m->last.time = before->to;
    struct dalcs_audit_stretch *stretch = dalcs_audit_reader_stretch(a, index, s->t_end);
    stretch->is_last = false;
    stretch->first_look = m->work.elements;
    return stretch;
}

void dalcs_audit_go_back(void *user, int index) {
    struct dalcs_audit_run *a = user;
    struct audit_members *m = &a->part[index];
    struct dalcs_radau_part *part = &a->radau->part[index];
    part->segment = m->present->segment;
    take_mode(part, m->present->mode);
    m->last.out = m->present->last_out;
    m->last.time = m->present->last_time;
}
