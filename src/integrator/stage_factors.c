#include "stages_internal.h"

enum dalcs_status dalcs_stage_factors_build(struct dalcs_stages *stages,
                                            struct dalcs_stage_entry *entry) {
    return dalcs_stage_map_build(stages, entry);
}

enum dalcs_status dalcs_stage_factors_apply(struct dalcs_stages *stages,
                                            const struct dalcs_stage_entry *entry, const double *in,
                                            double *out) {
    dalcs_stage_map_apply(stages, entry, in, out);
    return DALCS_OK;
}

void dalcs_stage_factors_destroy(struct dalcs_stage_factors *factors) {
    (void)factors;
}
