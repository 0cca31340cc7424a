/* part.c - checks one part: structure and linear programs at any size, matrices up to a limit. */
#include "part.h"

#include "facts.h"

#include "rcp.h"

#include <math.h>

static enum dalcs_status hold_switches(struct dalcs_facts *facts) {
    const struct dalcs_system *s = facts->system;
    facts->hold = dalcs_arena_alloc(facts->f->work, (size_t)s->n_pairs + 1, sizeof(*facts->hold));
    if (facts->hold == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < s->n_pairs; i++) {
        const struct dalcs_pair *pair = &s->pair[i];
        if (pair->kind == DALCS_PAIR_SWITCH) {
            facts->hold[i] = pair->initially_on ? DALCS_HELD_CLOSED : DALCS_HELD_OPEN;
            facts->pairs.n_switches++;
            facts->pairs.has_fed_back_switch = facts->pairs.has_fed_back_switch || !pair->is_direct;
        } else {
            facts->pairs.n_diodes++;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status check_dense(struct dalcs_facts *facts) {
    struct dalcs_arena *work = facts->f->work;
    DALCS_TRY(dalcs_blocks_build(&facts->blocks, work, facts->system, facts->hold));
    DALCS_TRY(dalcs_lcs_build(&facts->lcs, work, &facts->blocks));
    facts->is_dense = true;
    facts->has_lcs = facts->lcs.obstacle == NULL;
    if (!facts->has_lcs) {
        DALCS_TRY(
            dalcs_findings_condition(facts->f, "LCS", "Brogliato 2022, remark 5.13",
                                     "the equations reduce to a linear complementarity system",
                                     DALCS_NO, "%s", facts->lcs.obstacle));
    } else {
        DALCS_TRY(dalcs_lure_check(facts->f, &facts->lcs, &facts->cones, &facts->lure));
    }
    bool is_small = facts->blocks.p <= DALCS_MOST_ONE_STEP &&
                    facts->blocks.m <= DALCS_MOST_ONE_STEP &&
                    facts->blocks.n <= DALCS_MOST_ONE_STEP;
    if (is_small) {
        DALCS_TRY(dalcs_brogliato_check(facts->f, &facts->blocks, facts->h, facts->jumps,
                                        &facts->brogliato.of));
        facts->brogliato.is_there = true;
    } else {
        DALCS_TRY(dalcs_findings_condition(
            facts->f, "A1-A13", "Brogliato 2022, assumptions 1 to 13",
            "conditions on the blocks of (2.1) and (3.2)", DALCS_NOT_CHECKED, "too large"));
    }
    if (!facts->system->monotone || facts->pairs.n_diodes == 0) {
        DALCS_TRY(dalcs_modes_find(&facts->modes, work, &facts->lcs));
    }
    if (facts->has_lcs) {
        DALCS_TRY(dalcs_relay_check(facts->f, &facts->lcs, &facts->modes, &facts->relays));
        DALCS_TRY(dalcs_rcp_check(facts->f, &facts->lcs, &facts->modes, facts->h,
                                  facts->system->monotone || facts->lure.is_dissipative,
                                  &facts->steps_are_monotone));
    }
    return facts->has_lcs && !facts->system->monotone && !facts->lure.is_dissipative &&
                   facts->modes.growing.value[0] <= 0.0
               ? dalcs_passivity_refute(&facts->lcs, &facts->giving, work)
               : DALCS_OK;
}

/* The theorems that are checked are about matrices. Of products and functions they say nothing, and of the system with
 * these as given sources a verdict would be one of another circuit. */
static enum dalcs_status leave_open(struct dalcs_facts *facts) {
    static const char *const question[] = {"passive",     "exists",  "unique",      "multipliers",
                                           "jumps",       "step",    "convergence", "stable",
                                           "contracting", "periodic"};
    const struct dalcs_system *s = facts->system;
    facts->passive = DALCS_UNDECIDED;
    for (size_t k = 0; k < sizeof question / sizeof *question; k++) {
        DALCS_TRY(dalcs_findings_verdict(facts->f, question[k], DALCS_UNDECIDED,
                                         "the theorems are about linear parts with diodes",
                                         "undecided: %s%s %s not piecewise linear",
                                         s->smooth[0].element, s->n_smooth > 1 ? " and others" : "",
                                         s->n_smooth > 1 ? "are" : "is"));
    }
    return DALCS_OK;
}

static enum dalcs_status check(struct dalcs_facts *facts) {
    const struct dalcs_system *s = facts->system;
    DALCS_TRY(hold_switches(facts));
    if (s->n_smooth > 0) {
        return leave_open(facts);
    }
    DALCS_TRY(dalcs_cones_find(&facts->cones, facts->f->work, s, facts->hold));
    facts->obstacle = "too large";
    if (dalcs_system_n_columns(s) <= DALCS_MOST_DENSE) {
        enum dalcs_status status = check_dense(facts);
        if (status == DALCS_SINGULAR) { /* numbers that LAPACK finds no answer to */
            facts->obstacle = "its numbers are too far apart";
            facts->is_dense = facts->has_lcs = facts->brogliato.is_there = false;
        } else {
            DALCS_TRY(status);
        }
    }
    if (!facts->is_dense) {
        DALCS_TRY(dalcs_findings_condition(
            facts->f, "dense", "all conditions on matrices",
            "eigenvalues, ranks, P B = C', assumptions 1 to 13", DALCS_NOT_CHECKED,
            "%s: %d equations and pairs; the limit is %d", facts->obstacle,
            dalcs_system_n_columns(s), DALCS_MOST_DENSE));
    }
    DALCS_TRY(dalcs_verdict_passive(facts));
    DALCS_TRY(dalcs_verdict_exists(facts));
    DALCS_TRY(dalcs_verdict_unique(facts));
    DALCS_TRY(dalcs_verdict_jumps(facts));
    DALCS_TRY(dalcs_verdict_step(facts));
    return dalcs_verdict_motion(facts);
}

/* Copies the results into the arena of the result. */
static enum dalcs_status hand_over(struct dalcs_checked_part *part,
                                   const struct dalcs_facts *facts) {
    const struct dalcs_findings *f = facts->f;
    struct dalcs_condition *condition =
        dalcs_arena_alloc(f->result, f->n_conditions + 1, sizeof(*condition));
    struct dalcs_verdict *verdict =
        dalcs_arena_alloc(f->result, f->n_verdicts + 1, sizeof(*verdict));
    if (condition == NULL || verdict == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < f->n_conditions; i++) {
        condition[i] = f->condition[i];
    }
    for (size_t i = 0; i < f->n_verdicts; i++) {
        verdict[i] = f->verdict[i];
    }
    const struct dalcs_system *s = facts->system;
    *part = (struct dalcs_checked_part){
        .n_equal = 1,
        .element = s->n_pairs > 0        ? s->pair[0].element
                   : s->n_x + s->n_z > 0 ? s->column[0].element
                                         : "",
        .states = s->n_x,
        .algebraic = s->n_z,
        .diodes = facts->pairs.n_diodes,
        .switches = facts->pairs.n_switches,
        .summary = dalcs_facts_summary(facts),
        .n_conditions = f->n_conditions,
        .condition = condition,
        .n_verdicts = f->n_verdicts,
        .verdict = verdict,
    };
    return part->summary == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_part_check(struct dalcs_checked_part *part, struct dalcs_arena *result,
                                   const struct dalcs_system *system,
                                   const struct dalcs_power *power, const bool *jumps, double h) {
    struct dalcs_arena work = {0};
    struct dalcs_findings f = {.result = result, .work = &work};
    struct dalcs_facts facts = {.f = &f, .system = system, .power = power, .jumps = jumps, .h = h};
    enum dalcs_status status = check(&facts);
    if (status == DALCS_OK) {
        status = hand_over(part, &facts);
    }
    dalcs_findings_finish(&f);
    dalcs_arena_finish(&work);
    return status;
}
