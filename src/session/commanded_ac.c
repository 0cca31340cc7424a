/* commanded_ac.c - .ac of a circuit whose switches follow a clock: around an operating point they do not move, and what
 * they do to a small signal is not there. */
#include "steady.h"

/* A source that repeats in a row of a matrix of inputs; -1: none. */
static int find_clock(const struct dalcs_circuit *c, const struct dalcs_system *s,
                      const struct dalcs_csr *a, int row, bool without_ac) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        const int stimulus = s->stimulus[a->j[k]];
        const struct dalcs_stimulus *of = stimulus >= 0 ? &c->stimulus[stimulus] : NULL;
        const bool has_ac = of != NULL && (of->ac_real != 0.0 || of->ac_imaginary != 0.0);
        if (of != NULL && dalcs_steady_repeats(of) && !(without_ac && has_ac)) {
            return stimulus;
        }
    }
    return -1;
}

/* Of what a switch reads in its own equations: one beside the sources of the small signal, for these may have a
 * waveform for .tran as well. */
static int find_clock_of_system(const struct dalcs_circuit *c, const struct dalcs_system *s) {
    int clock = -1;
    for (int row = 0; row < s->E.n_rows && clock < 0; row++) {
        clock = find_clock(c, s, &s->E, row, true);
    }
    return clock;
}

static enum dalcs_status refuse(struct dalcs_run *r, const char *element, int clock) {
    dalcs_diag_add(
        &r->s->diag, DALCS_ERROR, &r->s->circuit.analyses.ac.where,
        "add .pss, and .ac is the response around the periodic steady state; or use "
        "'dalcs bode'",
        "'%s' switches with '%s' in time: .ac around an operating point would leave it as it "
        "stands there",
        element, dalcs_steady_source_name(&r->s->circuit, clock));
    return DALCS_E_NETLIST;
}

enum dalcs_status dalcs_commanded_ac_refuse(struct dalcs_run *r) {
    const struct dalcs_network *network = &r->s->network;
    const struct dalcs_circuit *c = &r->s->circuit;
    for (int k = 0; k < network->n_systems; k++) {
        const struct dalcs_system *s = &network->system[k];
        int clock = -1;
        for (int d = 0; d < s->n_pairs && clock < 0; d++) {
            if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
                clock = s->pair[d].is_direct ? find_clock(c, s, &s->direct_control, d, false)
                                             : find_clock_of_system(c, s);
            }
            if (clock >= 0) {
                return refuse(r, s->pair[d].element, clock);
            }
        }
    }
    return DALCS_OK;
}
