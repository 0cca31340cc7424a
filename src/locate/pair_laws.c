/* pair_laws.c - the current of a closed pair by KCL and by Ohm.
 *
 * A capacitor of 0.1 F beside a diode, times the last digit of a volt, over a step of 0.2 ns, would be
 * 40 uA; its other node has 4 pF, or it has 70 mohm itself, and then rounding makes next to nothing. Or its
 * other node has nothing but another diode, whose current is known. */
#include "pair_laws.h"

#include "extremes.h"

#include <math.h>
#include <string.h>

struct dalcs_pair_rate *dalcs_pair_rate_create(struct dalcs_arena *arena, int n_pairs,
                                               int n_words) {
    struct dalcs_pair_rate *rate = dalcs_arena_alloc(arena, 1, sizeof(*rate));
    if (rate == NULL) {
        return NULL;
    }
    rate->mode = dalcs_arena_alloc(arena, (size_t)n_words, sizeof(*rate->mode));
    rate->of = dalcs_arena_alloc(arena, (size_t)n_pairs, sizeof(*rate->of));
    return rate->mode != NULL && rate->of != NULL ? rate : NULL;
}

/* F at a node, H of a coil; 0 of an algebraic row. */
static double storage_of(const struct dalcs_system *s, int row) {
    double sum = 0.0;
    for (int k = row < s->n_x ? s->P.p[row] : 0; row < s->n_x && k < s->P.p[row + 1]; k++) {
        sum += fabs(s->P.x[k]);
    }
    return sum;
}

/* The KCL rows that a pair's current enters, and the capacitance there. */
static void find_charges(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int d = 0; d < s->n_pairs; d++) {
        part->laws.pair_row[2 * d] = part->laws.pair_row[2 * d + 1] = -1;
    }
    for (int r = 0; r < n_equations; r++) {
        for (int k = s->A.p[r]; s->row_is_current[r] && k < s->A.p[r + 1]; k++) {
            int d = s->A.j[k] - n_equations;
            if (d >= 0) {
                int *row = &part->laws.pair_row[2 * d];
                row[row[0] < 0 ? 0 : 1] = r;
                part->laws.held_charge[d] = fmax(part->laws.held_charge[d], storage_of(s, r));
            }
        }
    }
}

/* The inductance of coils on the nodes of a pair. */
static void find_fluxes(struct dalcs_radau_part *part, double *at_node /* [n_equations], 0 */) {
    const struct dalcs_system *s = part->component->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < s->n_x; r++) {
        for (int k = s->A.p[r]; !s->row_is_current[r] && k < s->A.p[r + 1]; k++) {
            int c = s->A.j[k];
            if (c < n_equations && !s->column_is_current[c]) {
                at_node[c] = fmax(at_node[c], storage_of(s, r));
            }
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            int c = s->C.j[k];
            part->laws.held_flux[d] =
                fmax(part->laws.held_flux[d], c < n_equations ? at_node[c] : 0.0);
        }
    }
}

/* The algebraic columns that a reader looks at. is_read[n_equations], false. */
static void mark_read(const struct dalcs_system *s, bool *is_read) {
    int n_equations = dalcs_system_n_equations(s);
    for (int k = 0; s->reads.p != NULL && k < s->reads.p[s->reads.n_rows]; k++) {
        int column = s->reads.j[k];
        if (column >= s->n_x && column < n_equations) {
            is_read[column] = true;
        }
    }
}

/* Is one of these a column by which a state's rate follows: a current into a capacitor's node, a voltage at a coil?
 * Without readers a rate acts on what is next to it, and charges and fluxes there tell. */
static bool reads_rates(const struct dalcs_system *s, const bool *is_read) {
    bool is = false;
    for (int r = 0; r < s->n_x && !is; r++) {
        for (int k = s->A.p[r]; k < s->A.p[r + 1] && !is; k++) {
            int column = s->A.j[k];
            is = column < dalcs_system_n_equations(s) && is_read[column] &&
                 s->column_is_current[column] == s->row_is_current[r];
        }
    }
    return is;
}

static enum dalcs_status find_read_rates(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    struct dalcs_arena work = {0};
    bool *is_read = dalcs_arena_alloc(&work, (size_t)dalcs_system_n_equations(s), sizeof(*is_read));
    if (is_read != NULL) {
        mark_read(s, is_read);
        part->laws.reads_rates = reads_rates(s, is_read);
    }
    dalcs_arena_finish(&work);
    return is_read != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* row < 0: ground. */
static struct dalcs_pair_law law_of_node(const struct dalcs_system *s, int row,
                                         const double *inductance) {
    int n_equations = dalcs_system_n_equations(s);
    struct dalcs_pair_law law = {.holds = row >= 0};
    law.inductance = row >= 0 ? inductance[s->dual[row]] : 0.0;
    for (int k = row >= 0 ? s->A.p[row] : 0; row >= 0 && k < s->A.p[row + 1]; k++) {
        int c = s->A.j[k];
        bool is_branch = c >= n_equations || s->column_is_current[c];
        law.conductance += is_branch ? 0.0 : fabs(s->A.x[k]);
        law.holds = law.holds && (!is_branch || c < s->n_x || c >= n_equations);
    }
    law.capacitance = row >= 0 ? storage_of(s, row) : 0.0;
    return law;
}

static struct dalcs_pair_law law_of_resistance(const struct dalcs_system *s, int pair) {
    struct dalcs_pair_law law = {0};
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        if (s->C.j[k] == dalcs_system_n_equations(s) + pair && s->C.x[k] != 0.0) {
            law = (struct dalcs_pair_law){.holds = true, .conductance = 1.0 / fabs(s->C.x[k])};
        }
    }
    return law;
}

enum dalcs_status dalcs_pair_laws_find(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    find_charges(part);
    double *inductance = part->laws.inductance;
    find_fluxes(part, inductance);
    DALCS_TRY(find_read_rates(part));
    for (int d = 0; d < s->n_pairs; d++) {
        part->laws.law[DALCS_PAIR_LAWS * d] =
            law_of_node(s, part->laws.pair_row[2 * d], inductance);
        part->laws.law[DALCS_PAIR_LAWS * d + 1] =
            law_of_node(s, part->laws.pair_row[2 * d + 1], inductance);
        part->laws.law[DALCS_PAIR_LAWS * d + 2] = law_of_resistance(s, d);
    }
    return DALCS_OK;
}

/* By one of its laws; what other closed pairs carry away from its node is as well known as it is so far. */
static double rate_by_law(const struct dalcs_radau_part *part, int pair, int which) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_pair_law *law = &part->laws.law[DALCS_PAIR_LAWS * pair + which];
    if (!law->holds) {
        return INFINITY;
    }
    double rate = law->capacitance / part->segment.h + law->conductance;
    int row = which < 2 ? part->laws.pair_row[2 * pair + which] : -1;
    int n_equations = dalcs_system_n_equations(s);
    for (int k = row >= 0 ? s->A.p[row] : 0; row >= 0 && k < s->A.p[row + 1]; k++) {
        int other = s->A.j[k] - n_equations;
        if (other >= 0 && other != pair && dalcs_osnsp_is_on(&part->component->osnsp, other)) {
            rate += part->laws.rate->of[other];
        }
    }
    return rate;
}

/* From what each pair's nodes hold downwards, until no law makes less of any: every law adds to what it takes
 * from others, so two pairs cannot vouch for each other (D. E. Knuth, Inf. Process. Lett. 6(1), 1977). */
static void find_rates(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    int n_pairs = p->system->n_pairs;
    struct dalcs_pair_rate *rate = part->laws.rate;
    for (int d = 0; d < n_pairs; d++) {
        rate->of[d] = part->laws.held_charge[d] > 0.0 ? part->laws.held_charge[d] / part->segment.h
                                                      : INFINITY;
    }
    bool changes = true;
    for (int round = 0; round < n_pairs && changes; round++) {
        changes = false;
        for (int d = 0; d < n_pairs; d++) {
            for (int k = 0; k < DALCS_PAIR_LAWS && dalcs_osnsp_is_on(p, d); k++) {
                double by_law = rate_by_law(part, d, k);
                changes = changes || by_law < rate->of[d];
                rate->of[d] = dalcs_smaller(rate->of[d], by_law);
            }
        }
    }
    memcpy(rate->mode, p->mode, (size_t)p->n_words * sizeof(uint64_t));
    rate->h = part->segment.h;
}

double dalcs_pair_charge_rate(const struct dalcs_radau_part *part, int pair) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_pair_rate *rate = part->laws.rate;
    double held = part->laws.held_charge[pair] / part->segment.h;
    if (p->system->n_pairs > DALCS_MANY_PAIRS) {
        return held;
    }
    if (rate->h != part->segment.h || !dalcs_mode_is(rate->mode, p->mode, p->n_words)) {
        find_rates(part);
    }
    return dalcs_smaller(held, part->segment.rounding * rate->of[pair]);
}

/* The largest current at the nodes of the step, in A, of what a KCL row holds. */
static double largest_current(const struct dalcs_radau_part *part, int row) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_equations = dalcs_system_n_equations(s);
    double largest = 0.0;
    for (int i = s->A.p[row]; i < s->A.p[row + 1]; i++) {
        int c = s->A.j[i];
        bool is_current = c < n_equations
                              ? s->column_is_current[c]
                              : dalcs_osnsp_is_on(&part->component->osnsp, c - n_equations);
        for (int k = 0; k < l->n_nodes && is_current; k++) {
            largest = dalcs_larger(largest, fabs(part->segment.out[k * l->stride + c]));
        }
    }
    return largest;
}

double dalcs_pair_flux(const struct dalcs_radau_part *part, int pair) {
    double flux = 0.0;
    for (int e = 0; e < 2; e++) {
        double inductance = part->laws.law[DALCS_PAIR_LAWS * pair + e].inductance;
        if (inductance > 0.0) {
            double largest = largest_current(part, part->laws.pair_row[2 * pair + e]);
            flux = dalcs_larger(flux, inductance * largest);
        }
    }
    return flux;
}
