/* decided_energy.c - the energies that sources alone decide: integrals of products of their waves. */
#include "energy_entries.h"

#include "refute.h"
#include "rounding.h"
#include "source_products.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns as sums of the waves of sources: the constant 1, then each input that varies. */
struct waves {
    int n;
    const struct dalcs_stimulus **stimulus; /* [n] */
    int *of_input;                          /* [n_inputs] */
    double *gain;                           /* [n_columns][n] */
    bool *is_bound;                         /* [n] a sum of others while the run lasts */
    double *bond;                           /* [n][n] of which others: factors */
    double *first, *second;                 /* [n] work */
    double *power;                          /* [n_accounts][n][n] */
};

static const struct dalcs_stimulus ONE = {.kind = DALCS_STIMULUS_DC, .dc = 1.0};

static const struct dalcs_stimulus *stimulus_of(const struct dalcs_component *c, int input) {
    return input > 0 ? &c->circuit->stimulus[c->system->stimulus[input]] : &ONE;
}

/* The inputs of one wave alone, and of its part in those that are bound. */
static void unit_inputs(const struct dalcs_component *c, const struct waves *w, int wave,
                        double *inputs) {
    for (int k = 0; k < c->system->n_inputs; k++) {
        int of = w->of_input[k];
        double constant = k > 0 ? stimulus_of(c, k)->dc : 1.0;
        double part = of == wave ? 1.0 : w->is_bound[of] ? w->bond[of * w->n + wave] : 0.0;
        inputs[k] = part * (of > 0 ? 1.0 : constant);
    }
}

/* Binds one wave to others: where one alone has no answer, sources close a loop or feed a part, and a sum of waves was 0
 * all the time that there were answers. */
static enum dalcs_status bind(struct dalcs_component *c, struct waves *w, int wave) {
    const struct dalcs_system *s = c->system;
    double *sum = w->first;
    double *inputs = c->probe_u + s->n_x;
    double most = 0.0;
    bool is_certain;
    DALCS_TRY(dalcs_osnsp_refute(&c->osnsp, 0.0, c->probe_u, &is_certain));
    for (int k = 0; k < w->n; k++) {
        unit_inputs(c, w, k, inputs);
        sum[k] = w->is_bound[k] ? 0.0 : dalcs_osnsp_along_ray(&c->osnsp, inputs);
        most = fmax(most, fabs(sum[k]));
    }
    if (!is_certain || !(fabs(sum[wave]) > 0.0)) {
        return DALCS_INFEASIBLE;
    }
    for (int k = 0; k < w->n; k++) {
        bool takes_part = k != wave && fabs(sum[k]) > dalcs_answer_rounded * most;
        w->bond[wave * w->n + k] = takes_part ? -sum[k] / sum[wave] : 0.0;
    }
    w->is_bound[wave] = true;
    for (int b = 0; b < w->n; b++) { /* those that were bound to it before */
        double through = w->bond[b * w->n + wave];
        w->bond[b * w->n + wave] = 0.0;
        for (int k = 0; k < w->n; k++) {
            w->bond[b * w->n + k] += through * w->bond[wave * w->n + k];
        }
    }
    return DALCS_OK;
}

/* The answer to one wave. */
static enum dalcs_status find_gain(struct dalcs_component *c, struct waves *w, int wave) {
    const struct dalcs_system *s = c->system;
    unit_inputs(c, w, wave, c->probe_u + s->n_x);
    DALCS_TRY(dalcs_component_solve(c, 0.0, c->probe_u, c->scratch));
    for (int i = 0; i < dalcs_system_n_columns(s); i++) {
        w->gain[i * w->n + wave] = c->scratch[i];
    }
    return DALCS_OK;
}

/* Bystanders' gains are known; other columns are answers to each wave alone, but for those that are bound. */
static enum dalcs_status find_gains(struct dalcs_component *c, const struct dalcs_bystanders *b,
                                    struct waves *w) {
    const struct dalcs_system *s = c->system;
    bool all = s->n_x == 0 && s->n_pairs == 0 && b->n < dalcs_system_n_equations(s);
    for (int k = 0; k < w->n; k++) {
        if (all) {
            enum dalcs_status status = find_gain(c, w, k);
            DALCS_TRY(status == DALCS_INFEASIBLE ? bind(c, w, k) : status);
        }
        double *inputs = c->probe_u + s->n_x;
        unit_inputs(c, w, k, inputs);
        for (int i = 0; i < b->n && !all; i++) {
            double sum = 0.0;
            for (int j = 0; j < s->n_inputs; j++) {
                sum += b->gain[i * s->n_inputs + j] * inputs[j];
            }
            w->gain[b->column[i] * w->n + k] = sum;
        }
    }
    return DALCS_OK;
}

static void gain_of(const struct waves *w, const int *column, double *gain) {
    for (int k = 0; k < w->n; k++) {
        gain[k] = (column[0] >= 0 ? w->gain[column[0] * w->n + k] : 0.0) -
                  (column[1] >= 0 ? w->gain[column[1] * w->n + k] : 0.0);
    }
}

static void add_power(struct waves *w, const struct dalcs_power_term *term) {
    double *power = w->power + term->account * w->n * w->n;
    gain_of(w, term->first, w->first);
    switch (term->factor) {
    case DALCS_POWER_CONSTANT:
        memset(w->second, 0, (size_t)w->n * sizeof(double));
        w->second[0] = 1.0;
        break;
    case DALCS_POWER_SQUARE:
        memcpy(w->second, w->first, (size_t)w->n * sizeof(double));
        break;
    case DALCS_POWER_PRODUCT:
        gain_of(w, term->second, w->second);
        break;
    case DALCS_POWER_INPUT:
        memset(w->second, 0, (size_t)w->n * sizeof(double));
        w->second[w->of_input[term->input]] = 1.0;
        break;
    }
    for (int i = 0; i < w->n; i++) {
        for (int j = 0; j < w->n; j++) {
            power[i * w->n + j] += term->coefficient * w->first[i] * w->second[j];
        }
    }
}

/* Leaves out the waves of sources without power, such as those of gates, which have many edges. */
static void drop_idle(struct waves *w) {
    int n = w->n;
    int kept = 0;
    for (int k = 0; k < n; k++) {
        bool used = false;
        for (int i = 0; i < DALCS_N_POWER_ACCOUNTS * n; i++) {
            used =
                used || w->power[i * n + k] != 0.0 || w->power[(i / n * n + k) * n + i % n] != 0.0;
        }
        if (used) {
            w->stimulus[kept] = w->stimulus[k];
            w->of_input[kept++] = k; /* of no more use for inputs */
        }
    }
    for (int a = 0; a < DALCS_N_POWER_ACCOUNTS; a++) {
        for (int i = 0; i < kept; i++) {
            for (int j = 0; j < kept; j++) {
                w->power[(a * kept + i) * kept + j] =
                    w->power[(a * n + w->of_input[i]) * n + w->of_input[j]];
            }
        }
    }
    w->n = kept;
}

static enum dalcs_status integrate(struct dalcs_energy *energy, struct waves *w, double stop) {
    size_t n = (size_t)w->n;
    size_t n_terms = 0;
    for (size_t i = 0; i < n; i++) {
        n_terms += (size_t)dalcs_stimulus_n_terms(w->stimulus[i]);
    }
    struct dalcs_stimulus_piece *piece = dalcs_alloc(n, sizeof(*piece));
    struct dalcs_stimulus_term *term = dalcs_alloc(n_terms, sizeof(*term));
    double *integral = dalcs_alloc(n * n, sizeof(*integral));
    enum dalcs_status status =
        piece == NULL || term == NULL || integral == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (size_t i = 0, first = 0; i < n && status == DALCS_OK; i++) {
        piece[i].term = term + first;
        first += (size_t)dalcs_stimulus_n_terms(w->stimulus[i]);
    }
    if (status == DALCS_OK && n > 0) {
        dalcs_source_products(w->n, w->stimulus, stop, piece, integral);
        for (int a = 0; a < DALCS_N_POWER_ACCOUNTS; a++) {
            double sum = 0.0;
            for (size_t i = 0; i < n * n; i++) {
                sum += w->power[(size_t)a * n * n + i] * integral[i];
            }
            dalcs_energy_enter(energy, (enum dalcs_power_account)a, sum);
        }
    }
    free(piece);
    free(term);
    free(integral);
    return status;
}

enum dalcs_status dalcs_energy_enter_decided(struct dalcs_energy *energy,
                                             const struct dalcs_energy_part *part,
                                             struct dalcs_component *c,
                                             const struct dalcs_bystanders *b, double stop) {
    const struct dalcs_system *s = c->system;
    if (part->n_terms == part->n_stepped) {
        return DALCS_OK;
    }
    if (s->n_smooth > 0 && s->n_x == 0 && s->n_pairs == 0) {
        return dalcs_energy_enter_bent(energy, part, c, stop);
    }
    struct waves w = {.n = c->varying.n + 1};
    size_t n = (size_t)w.n;
    w.stimulus = dalcs_alloc(n, sizeof(const struct dalcs_stimulus *));
    w.of_input = dalcs_alloc((size_t)s->n_inputs, sizeof(*w.of_input));
    w.gain = dalcs_alloc((size_t)dalcs_system_n_columns(s) * n, sizeof(*w.gain));
    w.is_bound = dalcs_alloc(n, sizeof(*w.is_bound));
    w.bond = dalcs_alloc(n * n, sizeof(*w.bond));
    w.first = dalcs_alloc(n, sizeof(*w.first));
    w.second = dalcs_alloc(n, sizeof(*w.second));
    w.power = dalcs_alloc(DALCS_N_POWER_ACCOUNTS * n * n, sizeof(*w.power));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (w.stimulus != NULL && w.of_input != NULL && w.gain != NULL && w.is_bound != NULL &&
        w.bond != NULL && w.first != NULL && w.second != NULL && w.power != NULL) {
        w.stimulus[0] = &ONE;
        for (int i = 0; i < c->varying.n; i++) {
            w.stimulus[i + 1] = stimulus_of(c, c->varying.input[i]);
            w.of_input[c->varying.input[i]] = i + 1;
        }
        status = find_gains(c, b, &w);
    }
    if (status == DALCS_OK) {
        for (int i = part->n_stepped; i < part->n_terms; i++) {
            add_power(&w, &part->term[i]);
        }
        drop_idle(&w);
        status = integrate(energy, &w, stop);
    }
    free(w.stimulus);
    free(w.of_input);
    free(w.gain);
    free(w.is_bound);
    free(w.bond);
    free(w.first);
    free(w.second);
    free(w.power);
    return status;
}
