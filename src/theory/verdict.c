/* verdict.c - is it passive, and which steps may implicit Euler take? */
#include "facts.h"

#include <math.h>

#define HSW99 "Heemels, Schumacher and Weiland 1999, "
#define BG09  "Brogliato and Goeleven 2009, "
#define BG13  "Brogliato and Goeleven 2013, "
#define BT10  "Brogliato and Thibault 2010, "

/* ---- Passive -------------------------------------------------------------------------------- */

static enum dalcs_status not_passive_by_mode(struct dalcs_facts *facts) {
    const struct dalcs_mode *mode = &facts->modes.growing;
    const char *text = dalcs_mode_text(&facts->blocks, mode->is_on, facts->f->result);
    if (text == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_findings_verdict(
        facts->f, "passive", DALCS_NO,
        "an eigenvalue of a mode, which refutes every P of " BG09 "definition 1",
        "no: with %s and no source it grows as exp(t * %.4g/s)", text, mode->value[0]));
    return dalcs_motion_witness(facts->f, &facts->blocks, mode->value, mode->is_on, mode->y,
                                facts->power);
}

static enum dalcs_status not_passive_by_port(struct dalcs_facts *facts) {
    const struct dalcs_giving *g = &facts->giving;
    double *y;
    DALCS_TRY(dalcs_motion_columns(&facts->lcs, g, &y, facts->f->work));
    if (isinf(g->s[0])) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "passive", DALCS_NO, "D + D' has a negative eigenvalue",
            "no: it supplies energy at once to currents or voltages at its diodes"));
    } else if (g->s[0] == 0.0) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "passive", DALCS_NO, "H(j omega) + H(j omega)* has a negative eigenvalue",
            g->s[1] == 0.0
                ? "no: it supplies energy to constant currents or voltages at its diodes "
                  "(s = %.1g)"
                : "no: it supplies energy to sines of %.4g rad/s at its diodes",
            fabs(g->s[1])));
    } else {
        DALCS_TRY(dalcs_findings_verdict(facts->f, "passive", DALCS_NO,
                                         "H(s) + H(s)* has a negative eigenvalue, Re s > 0",
                                         "no: it supplies energy to currents or voltages at its "
                                         "diodes that grow as exp(t * %.4g/s)",
                                         g->s[0]));
    }
    return dalcs_motion_witness(facts->f, &facts->blocks, g->s, NULL, y, facts->power);
}

/* "; g1 supplies the energy" */
static enum dalcs_status name_givers(struct dalcs_facts *facts) {
    struct dalcs_verdict *v = &facts->f->verdict[facts->f->n_verdicts - 1];
    if (v->n_elements == 0) {
        return DALCS_OK;
    }
    const char *list = dalcs_join_names(facts->f->result, v->n_elements, v->element);
    v->sentence = list == NULL
                      ? NULL
                      : dalcs_arena_printf(facts->f->result, "%s; %s suppl%s the energy",
                                           v->sentence, list, v->n_elements == 1 ? "ies" : "y");
    return v->sentence == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_verdict_passive(struct dalcs_facts *facts) {
    facts->passive = DALCS_YES;
    if (facts->system->monotone) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "passive", DALCS_YES, "the energies of its elements: P is the stored energy",
            "yes: none of its R, L, C, K, diodes and switches can supply energy"));
        return facts->has_lcs
                   ? dalcs_lure_metric_witness(facts->f, &facts->lcs, &facts->lcs.storage, true)
                   : DALCS_OK;
    }
    if (facts->has_lcs && facts->lure.is_dissipative) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "passive", DALCS_YES, BG09 "definition 1, with the P of K10",
            facts->lure.by_energy ? "yes: the stored energy never grows by itself"
                                  : "yes: a quadratic form of the states never grows by "
                                    "itself"));
        return dalcs_lure_metric_witness(facts->f, &facts->lcs, &facts->lure.metric, true);
    }
    facts->passive = DALCS_NO;
    if (facts->is_dense && facts->modes.growing.value[0] > 0.0) {
        DALCS_TRY(not_passive_by_mode(facts));
        return name_givers(facts);
    }
    if (facts->has_lcs && facts->giving.is_found) {
        DALCS_TRY(not_passive_by_port(facts));
        return name_givers(facts);
    }
    if (facts->has_lcs && facts->lure.is_refuted) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "passive", DALCS_NO, "Z >= 0, which refutes every P of " BG09 "definition 1",
            "no: no quadratic form of the states bounds the energy that it supplies"));
        return dalcs_lure_refutation_witness(facts->f, &facts->lcs, &facts->lure.refutation, true);
    }
    facts->passive = facts->is_dense ? DALCS_UNDECIDED : DALCS_NOT_CHECKED;
    const char *open = facts->has_lcs ? facts->lure.open : facts->lcs.obstacle;
    return facts->is_dense
               ? dalcs_findings_verdict(facts->f, "passive", facts->passive, BG09 "definition 1",
                                        "undecided: the stored energy does not prove it and no "
                                        "motion refutes it; for other P: %s",
                                        open == NULL ? "D + D' has a negative eigenvalue" : open)
               : dalcs_findings_verdict(facts->f, "passive", facts->passive, BG09 "definition 1",
                                        "not checked: %s, and not passive by its elements alone",
                                        facts->obstacle);
}

/* ---- Steps ---------------------------------------------------------------------------------- */

static enum dalcs_status limit_of_steps(struct dalcs_facts *facts) {
    const struct dalcs_mode *mode = &facts->modes.fastest;
    const char *text = dalcs_mode_text(&facts->blocks, mode->is_on, facts->f->result);
    if (text == NULL) {
        return DALCS_E_NOMEM;
    }
    bool unique = facts->modes.minors == DALCS_MINORS_POSITIVE || facts->relays.is_P;
    DALCS_TRY(dalcs_findings_verdict(
        facts->f, "step", unique ? DALCS_CONDITIONAL : DALCS_UNDECIDED,
        HSW99 "corollary 3.12, by the eigenvalues of all modes",
        unique ? "implicit Euler has one solution for every h < %.6g s, where %s becomes singular"
               : "M(1/h) is not a P-matrix below h = %.6g s, where %s becomes singular",
        1.0 / mode->value[0], text));
    facts->f->verdict[facts->f->n_verdicts - 1].value = 1.0 / mode->value[0];
    return dalcs_motion_witness(facts->f, &facts->blocks, mode->value, mode->is_on, mode->y, NULL);
}

static enum dalcs_status possible_steps(struct dalcs_facts *facts) {
    if (facts->passive != DALCS_YES && facts->steps_are_monotone) {
        return dalcs_findings_verdict(
            facts->f, "step", DALCS_YES, HSW99 "theorem 4.9; monotone for every sigma = 1/h > 0",
            "implicit Euler is solvable for every h where a solution exists");
    }
    if (facts->passive == DALCS_YES) {
        return dalcs_findings_verdict(
            facts->f, "step", DALCS_YES, HSW99 "theorem 6.14; monotone for every sigma = 1/h > 0",
            "implicit Euler is solvable for every h where a solution exists");
    }
    if (!facts->modes.is_checked) {
        return dalcs_findings_verdict(facts->f, "step", DALCS_NOT_CHECKED, HSW99 "corollary 3.12",
                                      "not checked: too many modes (2^%d)", facts->pairs.n_diodes);
    }
    if (dalcs_has_limit(facts)) {
        return limit_of_steps(facts);
    }
    if (facts->relays.is_P) {
        return dalcs_findings_verdict(
            facts->f, "step", DALCS_YES, HSW99 "theorem 6.7, by the eigenvalues of all modes",
            "implicit Euler has one solution for every h: no mode has a positive real eigenvalue");
    }
    return dalcs_findings_verdict(
        facts->f, "step",
        facts->modes.minors == DALCS_MINORS_POSITIVE   ? DALCS_YES
        : facts->modes.minors == DALCS_MINORS_NEGATIVE ? DALCS_NO
                                                       : DALCS_UNDECIDED,
        HSW99 "corollary 3.12, by the eigenvalues of all modes",
        facts->modes.minors == DALCS_MINORS_POSITIVE
            ? "implicit Euler has one solution for every h: no mode has a positive real eigenvalue"
        : facts->modes.minors == DALCS_MINORS_NEGATIVE
            ? "there is no h for which implicit Euler has one solution for all data"
            : "undecided: M(1/h) has a minor that is 0");
}

static enum dalcs_status converges(struct dalcs_facts *facts) {
    const struct dalcs_lure *lure = &facts->lure;
    const struct dalcs_brogliato *b = &facts->brogliato.of;
    bool by_52 = b->converges_52 == DALCS_YES || b->converges_52 == DALCS_CONDITIONAL;
    bool by_59 = b->converges_59 == DALCS_YES || b->converges_59 == DALCS_CONDITIONAL;
    if (facts->brogliato.is_there && (by_52 || by_59)) {
        const char *which = by_52 ? "5.2" : "5.9";
        return dalcs_findings_verdict(
            facts->f, "convergence", by_52 ? b->converges_52 : b->converges_59,
            by_52 ? "Brogliato 2022, proposition 5.2" : "Brogliato 2022, propositions 5.6 and 5.9",
            b->jumping == NULL
                ? "implicit Euler converges (proposition %s)"
                : "implicit Euler converges (proposition %s) between the jumps of %s",
            which, b->jumping == NULL ? "" : b->jumping);
    }
    if (facts->has_lcs && lure->is_coupled && lure->D_is_semidefinite && lure->can_shift &&
        facts->cones.is_solved && facts->cones.is_qualified) {
        return dalcs_findings_verdict(
            facts->f, "convergence", DALCS_YES,
            BG09 "theorem 2 and remark 7; sources beside C x are moved into x",
            "implicit Euler converges with order 1 while the states do not jump (proposition 5.2 "
            "does not apply)");
    }
    return dalcs_findings_verdict(
        facts->f, "convergence",
        facts->brogliato.is_there || !facts->is_dense ? DALCS_UNDECIDED : DALCS_NOT_CHECKED,
        "Brogliato 2022, propositions 5.2 and 5.9", "%s",
        facts->brogliato.is_there
            ? "convergence of implicit Euler is not shown: neither proposition 5.2 nor 5.9 applies"
            : "convergence of implicit Euler was not checked: too large");
}

enum dalcs_status dalcs_verdict_step(struct dalcs_facts *facts) {
    DALCS_TRY(possible_steps(facts));
    return converges(facts);
}
