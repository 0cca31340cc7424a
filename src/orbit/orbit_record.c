/* orbit_record.c - segments of a run, kept. */
#include "orbit_record.h"

#include "radau.h"

#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_orbit_record_take(struct dalcs_orbit_record *record,
                                          const struct dalcs_radau_part *part,
                                          struct dalcs_arena *arena) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const size_t n_out = (size_t)l->n_nodes * (size_t)l->stride;
    const size_t n_words = (size_t)part->stages.n_words;
    double *out = dalcs_arena_alloc(arena, n_out, sizeof *out);
    uint64_t *mode = dalcs_arena_alloc(arena, n_words + 1, sizeof *mode);
    const int n = part->excitation.bystanders.n;
    double *ends = dalcs_arena_alloc(arena, 2 * (size_t)n + 1, sizeof *ends);
    if (out == NULL || mode == NULL || ends == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&record->segment, &record->capacity, (size_t)record->n + 1,
                         sizeof *record->segment));
    memcpy(out, part->segment.out, n_out * sizeof *out);
    memcpy(mode, part->component->osnsp.mode, n_words * sizeof *mode);
    for (int k = 0; k < n; k++) {
        ends[k] = dalcs_radau_bystander(part, k, part->segment.t, DALCS_RIGHT);
        ends[n + k] = dalcs_radau_bystander(part, k, part->segment.t_end, DALCS_LEFT);
    }
    record->segment[record->n++] = (struct dalcs_orbit_segment){
        part->segment.t, part->segment.t_end, part->segment.h, out, mode, {ends, ends + n}};
    return DALCS_OK;
}

void dalcs_orbit_record_finish(struct dalcs_orbit_record *record) {
    free(record->segment);
    *record = (struct dalcs_orbit_record){0};
}

int dalcs_orbit_record_find(const struct dalcs_orbit_record *record, double t,
                            enum dalcs_side side) {
    int low = 0;
    int high = record->n;
    while (low < high) { /* the first that ends at t or behind it */
        const int middle = low + (high - low) / 2;
        const double to = record->segment[middle].to;
        if (to < t || (side == DALCS_RIGHT && to == t)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < record->n ? low : -1;
}

/* Products of differences, as Lagrange wrote them. */
void dalcs_orbit_record_weights(const struct dalcs_collocation *method, double theta,
                                double *weight, double *rate) {
    const double *x = method->node;
    const int n = method->s + 1;
    for (int i = 0; i < n; i++) {
        weight[i] = 1.0;
        rate[i] = 0.0;
        for (int m = 0; m < n; m++) {
            if (m != i) {
                const double one = 1.0 / (x[i] - x[m]);
                rate[i] = (rate[i] * (theta - x[m]) + weight[i]) * one;
                weight[i] *= (theta - x[m]) * one;
            }
        }
    }
}
