/* verdict_exists.c - does a trajectory exist, and is it the only one? */
#include "facts.h"

#include <math.h>

#define HSW99 "Heemels, Schumacher and Weiland 1999, "
#define BG09  "Brogliato and Goeleven 2009, "
#define BG13  "Brogliato and Goeleven 2013, "
#define BT10  "Brogliato and Thibault 2010, "

/* ---- Exists --------------------------------------------------------------------------------- */

/* "v(c1) - v1 >= 0": a member's inequality, or its equation. */
static const char *inequality(const struct dalcs_facts *facts, const double *member,
                              bool is_equation) {
    const struct dalcs_system *s = facts->system;
    struct dalcs_arena *arena = facts->f->result;
    int n = dalcs_system_n_equations(s);
    int n_terms = s->n_x + s->n_inputs;
    double *sum = dalcs_arena_alloc(facts->f->work, (size_t)n_terms + 1, sizeof(*sum));
    const char *text = "";
    double largest = 0.0;
    if (sum == NULL) {
        return NULL;
    }
    for (int r = 0; r < n + s->n_pairs; r++) {
        const struct dalcs_csr *a = r < n ? &s->A : &s->C;
        const struct dalcs_csr *e = r < n ? &s->E : &s->F;
        int row = r < n ? r : r - n;
        for (int q = a->p[row]; q < a->p[row + 1]; q++) {
            if (a->j[q] < s->n_x) {
                sum[a->j[q]] += member[r] * a->x[q];
            }
        }
        for (int q = e->p[row]; q < e->p[row + 1]; q++) {
            sum[s->n_x + e->j[q]] += member[r] * e->x[q];
        }
    }
    for (int k = 0; k < n_terms; k++) {
        largest = fmax(largest, fabs(sum[k]));
    }
    int n_written = 0;
    for (int k = 0; k < n_terms && text != NULL; k++) {
        double c = sum[k] / largest;
        const char *name =
            k < s->n_x ? dalcs_column_name(s, k, arena) : dalcs_input_name(s, k - s->n_x);
        if (fabs(c) < 1e-7 || n_written > 8 || name == NULL) {
            continue;
        }
        const char *sign = c < 0.0 ? (n_written == 0 ? "-" : " - ") : n_written == 0 ? "" : " + ";
        text = fabs(fabs(c) - 1.0) < 1e-7
                   ? dalcs_arena_printf(arena, "%s%s%s", text, sign, name)
                   : dalcs_arena_printf(arena, "%s%s%.4g %s", text, sign, fabs(c), name);
        n_written++;
    }
    return text == NULL ? NULL
                        : dalcs_arena_printf(arena, is_equation ? "%s = 0" : "%s >= 0", text);
}

static enum dalcs_status add_member(struct dalcs_facts *facts, const double *member) {
    const struct dalcs_system *s = facts->system;
    int n = dalcs_system_n_equations(s) + s->n_pairs;
    struct dalcs_evidence w;
    size_t room = 0;
    for (int r = 0; r < n; r++) {
        room += member[r] != 0.0 ? 1 : 0;
    }
    if (room > 100) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_evidence_new(&w, facts->f, "multipliers", room));
    for (int r = 0; r < n; r++) {
        if (member[r] != 0.0) {
            int pair = r - dalcs_system_n_equations(s);
            const char *name =
                pair >= 0 ? s->pair[pair].element
                          : dalcs_arena_printf(facts->f->result, "%s %s",
                                               dalcs_label_equation(s->row[r].kind),
                                               s->row[r].element == NULL ? "?" : s->row[r].element);
            if (name == NULL) {
                return DALCS_E_NOMEM;
            }
            dalcs_evidence_put(&w, name, member[r], 0.0);
        }
    }
    return dalcs_findings_witness(facts->f, true, &w);
}

static enum dalcs_status add_point(struct dalcs_facts *facts) {
    const struct dalcs_system *s = facts->system;
    int n = dalcs_system_n_columns(s);
    struct dalcs_evidence w;
    if (n > 60) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_evidence_new(&w, facts->f, "point", (size_t)n));
    for (int c = 0; c < n; c++) {
        const char *name = dalcs_column_name(s, c, facts->f->result);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        dalcs_evidence_put(&w, name, facts->cones.point[c], 0.0);
    }
    return dalcs_findings_witness(facts->f, true, &w);
}

/* Inputs that a member without states may restrict: -1 when none. */
static int asked_input(const struct dalcs_facts *facts, const double **member) {
    for (int j = 0; j < facts->system->n_inputs; j++) {
        const struct dalcs_cone_range *range = &facts->cones.range[DALCS_CONE_SOURCES][j];
        bool is_constant = facts->system->input_element[j] == NULL;
        if (range->lower < 0.0) {
            *member = range->lowest;
            return j;
        }
        if (range->upper > 0.0 && !is_constant) {
            *member = range->highest;
            return j;
        }
    }
    return -1;
}

/* Does a point qualify, and does nothing ask a source to be 0, as where an open switch cuts it off? That point is one
 * without sources: what equations without diodes ask of them it does not tell. */
static bool is_qualified(const struct dalcs_facts *facts) {
    const double *member;
    return facts->cones.is_solved && facts->cones.is_qualified && asked_input(facts, &member) < 0;
}

/* One step of a monotone problem has a solution exactly when its constraints can be met. */
static enum dalcs_status exists_if_feasible(struct dalcs_facts *facts) {
    const struct dalcs_cones *cones = &facts->cones;
    const double *member = NULL;
    if (!cones->is_solved) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_NOT_CHECKED,
                                      "monotone linear complementarity",
                                      "wherever the constraints of the diodes are feasible; "
                                      "testing this needs linear programs (GLPK)");
    }
    if (is_qualified(facts)) {
        const struct dalcs_lure *lure = &facts->lure;
        bool swept = facts->has_lcs && lure->is_coupled && lure->D_is_zero;
        bool shifted = facts->has_lcs && lure->is_coupled && lure->can_shift;
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "exists", DALCS_YES,
            swept     ? BT10 "theorem 3.5 (K1, K2)"
            : shifted ? BG09 "theorem 2 (K8); " BG13 "theorem 5.6"
                      : HSW99 "theorem 6.14; with sources each step is monotone and feasible (K8)",
            "yes: for every start and every source"));
        return add_point(facts);
    }
    int asked = asked_input(facts, &member);
    if (asked < 0) {
        DALCS_TRY(dalcs_findings_verdict(facts->f, "exists", DALCS_YES,
                                         "monotone linear complementarity: feasible",
                                         "yes: for every start and every source; no loop or cutset "
                                         "of diodes has a source in it"));
        return cones->ray != NULL ? add_member(facts, cones->ray) : DALCS_OK;
    }
    const struct dalcs_cone_range *range = &cones->range[DALCS_CONE_SOURCES][asked];
    bool is_equation = cones->is_qualified && range->lower < 0.0 && range->upper > 0.0;
    const char *text = inequality(facts, is_equation ? range->highest : member, is_equation);
    if (text == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_findings_verdict(
        facts->f, "exists", DALCS_CONDITIONAL,
        is_equation ? "Farkas' lemma" : "Farkas' lemma; " BT10 "(22) fails",
        is_equation ? "only while %s: sources alone, with the switches where they start"
                    : "only while %s: a loop or cutset of diodes and sources",
        text));
    return add_member(facts, member);
}

/* Names of the pairs in the minor that is not positive. */
static enum dalcs_status add_minor(struct dalcs_facts *facts) {
    const struct dalcs_modes *modes = &facts->modes;
    struct dalcs_evidence w;
    DALCS_TRY(dalcs_evidence_new(&w, facts->f, "minor", (size_t)facts->lcs.m + 2));
    dalcs_evidence_put(&w, "sigma", modes->bad_sigma, 0.0);
    dalcs_evidence_put(&w, "value", modes->bad_minor, 0.0);
    for (int i = 0; i < facts->lcs.m; i++) {
        if (modes->bad[i]) {
            const char *name = dalcs_lcs_u_name(&facts->lcs, i, facts->f->result);
            if (name == NULL) {
                return DALCS_E_NOMEM;
            }
            dalcs_evidence_put(&w, name, 1.0, 0.0);
        }
    }
    return dalcs_findings_witness(facts->f, true, &w);
}

enum dalcs_status dalcs_verdict_exists(struct dalcs_facts *facts) {
    if (facts->passive == DALCS_YES) {
        return exists_if_feasible(facts);
    }
    const struct dalcs_lure *lure = &facts->lure;
    if (facts->has_lcs && facts->lcs.m == 0) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_YES, "linear equations",
                                      "yes: it is linear, for every start and source");
    }
    if (facts->has_lcs && lure->D_is_P) {
        return dalcs_findings_verdict(
            facts->f, "exists", DALCS_YES, BT10 "appendix A.4 (K6)",
            "yes: the diodes are functions of the states, for every start "
            "and source");
    }
    bool qualified = is_qualified(facts);
    if (facts->has_lcs && lure->D_is_zero && lure->is_coupled && qualified) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_YES, BT10 "theorem 3.5 (K1, K2)",
                                      "yes: for every start and source");
    }
    if (facts->has_lcs && lure->is_block_coupled && qualified) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_YES,
                                      BT10 "section 3.3; " BG09 "theorem 1 (K7)",
                                      "yes: for every start and source");
    }
    if (facts->relays.is_P || dalcs_are_relays(facts)) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_YES,
                                      facts->relays.is_P ? HSW99 "theorems 6.7 to 6.9 (relay-P)"
                                                         : BG13 "section 6.2 (relay-K1)",
                                      "yes: every start has a solution, relays included");
    }
    if (facts->steps_are_monotone && qualified) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_YES,
                                      HSW99 "theorem 4.1: each step is monotone and feasible (K8)",
                                      "yes: every start has an initial solution");
    }
    if (facts->modes.minors == DALCS_MINORS_POSITIVE) {
        return dalcs_findings_verdict(facts->f, "exists", DALCS_YES,
                                      HSW99 "corollary 3.12, theorem 4.1",
                                      "yes: every start has an initial solution");
    }
    if (facts->modes.minors == DALCS_MINORS_NEGATIVE) {
        DALCS_TRY(dalcs_findings_verdict(facts->f, "exists", DALCS_UNDECIDED, HSW99 "theorem 3.3",
                                         "not for all starts and sources, or not unique: M(1/h) "
                                         "is not a P-matrix for small h"));
        return add_minor(facts);
    }
    return dalcs_findings_verdict(facts->f, "exists", DALCS_UNDECIDED, "no theorem tried applies",
                                  "undecided");
}

/* ---- Unique --------------------------------------------------------------------------------- */

static enum dalcs_status unique_states(struct dalcs_facts *facts) {
    const struct dalcs_lure *lure = &facts->lure;
    const char *given =
        facts->pairs.has_fed_back_switch ? ", for given positions of its switches" : "";
    if (facts->passive == DALCS_YES) {
        return dalcs_findings_verdict(facts->f, "unique", DALCS_YES,
                                      BG09 "theorem 2; " HSW99 "theorem 6.14", "yes: the states%s",
                                      given);
    }
    if (facts->has_lcs &&
        (lure->D_is_P || lure->is_block_coupled || (lure->D_is_zero && lure->is_coupled))) {
        return dalcs_findings_verdict(facts->f, "unique", DALCS_YES,
                                      lure->D_is_P             ? BT10 "appendix A.4 (K6)"
                                      : lure->is_block_coupled ? BT10 "section 3.3; " BG09
                                                                      "theorem 1 (K7)"
                                                               : BT10 "theorem 3.5 (K1)",
                                      "yes: the states%s", given);
    }
    if (facts->relays.is_P || dalcs_are_relays(facts)) {
        return dalcs_findings_verdict(facts->f, "unique", DALCS_YES,
                                      facts->relays.is_P ? HSW99 "theorems 6.7 to 6.9 (relay-P)"
                                                         : BG13 "section 6.2 (relay-K1)",
                                      "yes: the states%s", given);
    }
    if (facts->steps_are_monotone) {
        return dalcs_findings_verdict(facts->f, "unique", DALCS_YES, HSW99 "theorem 4.9",
                                      "yes: the states, of initial solutions%s", given);
    }
    if (facts->modes.minors == DALCS_MINORS_POSITIVE) {
        return dalcs_findings_verdict(
            facts->f, "unique", DALCS_YES, HSW99 "corollary 3.12, theorem 4.9",
            dalcs_has_limit(facts) ? "yes: states and diodes, by steps below the limit%s"
                                   : "yes: states and diodes%s",
            given);
    }
    if (facts->modes.minors == DALCS_MINORS_NEGATIVE) {
        DALCS_TRY(dalcs_findings_verdict(facts->f, "unique", DALCS_NO,
                                         HSW99 "theorem 3.3, corollary 3.12",
                                         "no: a principal minor of M(s) is negative for large s, "
                                         "so some starts and sources have "
                                         "several solutions or none"));
        return add_minor(facts);
    }
    return dalcs_findings_verdict(facts->f, "unique", DALCS_UNDECIDED, "no theorem tried applies",
                                  "undecided");
}

static enum dalcs_status unique_multipliers(struct dalcs_facts *facts) {
    if (!facts->has_lcs) {
        return dalcs_findings_verdict(facts->f, "multipliers", DALCS_NOT_CHECKED, "K13",
                                      "not checked: %s",
                                      facts->is_dense ? facts->lcs.obstacle : facts->obstacle);
    }
    const struct dalcs_lcs *l = &facts->lcs;
    const char **name =
        dalcs_arena_alloc(facts->f->result, (size_t)(l->m + facts->blocks.p) + 1, sizeof(*name));
    size_t n = 0;
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    bool by_minors = facts->modes.minors == DALCS_MINORS_POSITIVE || facts->relays.is_P;
    for (int i = 0; i < l->m; i++) {
        if (facts->lure.in_kernel[i] && !by_minors) {
            name[n++] = dalcs_lcs_u_name(l, i, facts->f->result);
        }
    }
    for (int k = 0; k < facts->blocks.p; k++) {
        if (l->z_is_free[k]) {
            name[n++] =
                dalcs_column_name(facts->system, facts->blocks.z_column[k], facts->f->result);
        }
    }
    for (size_t i = 0; i < n; i++) {
        if (name[i] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    if (n == 0) {
        return dalcs_findings_verdict(facts->f, "multipliers", DALCS_YES,
                                      facts->relays.is_P ? HSW99 "theorem 6.7 (relay-P)"
                                      : by_minors        ? HSW99 "corollary 3.12"
                                                         : BG09 "remarks 3 and 4 (K13)",
                                      "yes: currents and voltages of all diodes");
    }
    const char *list = dalcs_join_names(facts->f->result, n, name);
    DALCS_TRY(list == NULL
                  ? DALCS_E_NOMEM
                  : dalcs_findings_verdict(
                        facts->f, "multipliers", DALCS_CONDITIONAL,
                        BG09 "remarks 3 and 4 (K13): a sufficient condition",
                        "not shown of %s: some combination of them has no effect on the states",
                        list));
    facts->f->verdict[facts->f->n_verdicts - 1].element = name;
    facts->f->verdict[facts->f->n_verdicts - 1].n_elements = n;
    return DALCS_OK;
}

enum dalcs_status dalcs_verdict_unique(struct dalcs_facts *facts) {
    DALCS_TRY(unique_states(facts));
    return unique_multipliers(facts);
}
