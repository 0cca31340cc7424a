/* verdict_motion.c - the answers about whole trajectories: jumps, stability, contraction. */
#include "facts.h"

#include <math.h>
#include <string.h>

#define HSW99 "Heemels, Schumacher and Weiland 1999, "
#define BG09  "Brogliato and Goeleven 2009, "
#define BG13  "Brogliato and Goeleven 2013, "
#define BT10  "Brogliato and Thibault 2010, "

/* ---- Jumps ---------------------------------------------------------------------------------- */

/* Inputs that bound states, into two lists: those that jump, those that do not. */
static enum dalcs_status list_causes(const struct dalcs_facts *facts, const char ***name,
                                     size_t n[2]) {
    const struct dalcs_system *s = facts->system;
    for (int k = 0; k < 2; k++) {
        name[k] = dalcs_arena_alloc(facts->f->result, (size_t)s->n_inputs + 1, sizeof(*name[k]));
        n[k] = 0;
        if (name[k] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    for (int j = 0; j < s->n_inputs; j++) {
        const struct dalcs_cone_range *range = &facts->cones.range[DALCS_CONE_STATES][j];
        if (s->input_element[j] != NULL && (range->lower < 0.0 || range->upper > 0.0)) {
            int k = facts->jumps == NULL || facts->jumps[j] ? 0 : 1;
            name[k][n[k]++] = s->input_element[j];
        }
    }
    return DALCS_OK;
}

static enum dalcs_status describe_causes(struct dalcs_facts *facts) {
    const char **name[2];
    size_t n[2];
    DALCS_TRY(list_causes(facts, name, n));
    const char *jumping = dalcs_join_names(facts->f->result, n[0], name[0]);
    const char *still = dalcs_join_names(facts->f->result, n[1], name[1]);
    bool moves = facts->pairs.n_switches > 0;
    if (jumping == NULL || still == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *source = BT10 "theorem 3.5, remark 3.6, (24)-(26)";
    if (n[0] > 0) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "jumps", DALCS_CONDITIONAL, source, "states may jump where %s step%s%s",
            jumping, n[0] == 1 ? "s" : "", moves ? " and where a switch moves" : ""));
    } else if (n[1] > 0) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "jumps", moves ? DALCS_CONDITIONAL : DALCS_YES, source,
            "states never jump after the start%s: only a step of %s could cause a jump, and %s "
            "none",
            moves ? " but where a switch moves" : "", still, n[1] == 1 ? "it has" : "they have"));
    } else {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "jumps", moves ? DALCS_CONDITIONAL : DALCS_YES, source,
            "states never jump after the start%s: no source acts on their constraints",
            moves ? " but where a switch moves" : ""));
    }
    facts->f->verdict[facts->f->n_verdicts - 1].element = name[0];
    facts->f->verdict[facts->f->n_verdicts - 1].n_elements = n[0];
    return DALCS_OK;
}

enum dalcs_status dalcs_verdict_jumps(struct dalcs_facts *facts) {
    const struct dalcs_lure *lure = &facts->lure;
    if (facts->has_lcs && facts->lcs.index_steps == 0 && facts->pairs.n_switches == 0 &&
        (lure->D_is_P || facts->lcs.m == 0)) {
        return dalcs_findings_verdict(facts->f, "jumps", DALCS_YES,
                                      BT10 "appendix A.4 (K6): an ordinary differential equation",
                                      "states are continuous for all sources");
    }
    if (facts->has_lcs && facts->lcs.index_steps == 0 && facts->pairs.n_switches == 0 &&
        dalcs_are_relays(facts)) {
        return dalcs_findings_verdict(facts->f, "jumps", DALCS_YES,
                                      HSW99 "theorems 6.7 to 6.9; " BG13 "section 6.2",
                                      "states are continuous: the output of a relay is bounded");
    }
    bool has_rule = facts->passive == DALCS_YES ||
                    (facts->has_lcs && (lure->is_block_coupled || facts->lcs.m == 0 ||
                                        (lure->D_is_zero && lure->is_coupled)));
    if (!has_rule) {
        return dalcs_findings_verdict(facts->f, "jumps", DALCS_UNDECIDED,
                                      "no jump rule applies to it", "undecided");
    }
    if (!facts->cones.is_solved) {
        return dalcs_findings_verdict(facts->f, "jumps", DALCS_NOT_CHECKED, BT10 "remark 3.6",
                                      "not checked: needs linear programs (GLPK)");
    }
    return describe_causes(facts);
}

/* ---- Stability ------------------------------------------------------------------------------ */

/* No diode, no switch that moves: the eigenvalues decide. */
static enum dalcs_status judge_linear(struct dalcs_facts *facts) {
    double slowest = facts->modes.slowest;
    const char *source = "eigenvalues: the part is linear";
    bool decays = slowest < 0.0 && facts->lcs.n > 0;
    bool empty = facts->lcs.n == 0;
    DALCS_TRY(dalcs_findings_verdict(
        facts->f, "stable",
        slowest < 0.0 || empty ? DALCS_YES
        : slowest > 0.0        ? DALCS_NO
                               : DALCS_UNDECIDED,
        source,
        empty           ? "yes: it has no state"
        : slowest < 0.0 ? "yes: the slowest motion dies out as exp(-t * %.4g/s)"
        : slowest > 0.0 ? "no: a motion grows as exp(t * %.4g/s)"
                        : "not asymptotically: an eigenvalue is on the imaginary axis",
        fabs(slowest)));
    DALCS_TRY(dalcs_findings_verdict(
        facts->f, "contracting", decays || empty ? DALCS_YES : DALCS_NO, source,
        decays || empty ? "yes: all trajectories meet" : "no: trajectories do not meet"));
    if (decays) {
        facts->f->verdict[facts->f->n_verdicts - 1].value = -slowest;
    }
    return dalcs_findings_verdict(
        facts->f, "periodic", decays || empty ? DALCS_YES : DALCS_UNDECIDED, source,
        decays || empty ? "one periodic steady state for periodic sources, which attracts all "
                          "trajectories"
                        : "no unique periodic steady state is shown");
}

static enum dalcs_status judge_stability(struct dalcs_facts *facts) {
    if (facts->passive == DALCS_YES) {
        return dalcs_findings_verdict(facts->f, "stable", DALCS_YES, BG09 "theorems 3 and 4",
                                      facts->pairs.has_fed_back_switch
                                          ? "yes: the stored energy never grows without sources"
                                          : "yes: the distance of two trajectories never grows, in "
                                            "the norm of the stored energy");
    }
    const struct dalcs_mode *mode = &facts->modes.growing;
    if (facts->is_dense && mode->value[0] > 0.0) {
        const char *text = dalcs_mode_text(&facts->blocks, mode->is_on, facts->f->result);
        return text == NULL ? DALCS_E_NOMEM
                            : dalcs_findings_verdict(
                                  facts->f, "stable", DALCS_UNDECIDED, "an eigenvalue of a mode",
                                  "not shown: with %s it grows as exp(t * %.4g/s) while that lasts",
                                  text, mode->value[0]);
    }
    return dalcs_findings_verdict(facts->f, "stable", DALCS_UNDECIDED, BG09 "theorem 3",
                                  "not shown: no P was found");
}

static enum dalcs_status judge_contraction(struct dalcs_facts *facts) {
    const struct dalcs_lure *lure = &facts->lure;
    const char *held = facts->pairs.n_switches > 0 ? ", with the switches where they start" : "";
    bool applies = facts->passive == DALCS_YES && facts->has_lcs && lure->is_dissipative;
    if (applies && lure->rate.value > 0.0) {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "contracting", facts->pairs.n_switches > 0 ? DALCS_CONDITIONAL : DALCS_YES,
            BG09 "theorem 3.2; " BG13 "proposition 7.3, (40) in the norm of P",
            "yes: trajectories meet at least as exp(-t * %.4g/s)%s", lure->rate.value, held));
        facts->f->verdict[facts->f->n_verdicts - 1].value = lure->rate.value;
        DALCS_TRY(dalcs_lure_metric_witness(facts->f, &facts->lcs, &lure->rate.metric, true));
    } else {
        DALCS_TRY(dalcs_findings_verdict(
            facts->f, "contracting", facts->has_lcs ? DALCS_UNDECIDED : DALCS_NOT_CHECKED,
            BG09 "definition 2",
            !facts->has_lcs ? "not checked: no reduced system"
            : !applies
                ? "not shown: no P was found in whose norm distances of trajectories do not grow"
            : lure->lossless == 0
                ? "trajectories meet, at a rate that is not known: %s"
                : "not shown: motions lose nothing in the norm of the P found; %s",
            applies ? lure->rate.open : ""));
    }
    bool unique = applies && lure->lossless == 0 && facts->pairs.n_switches == 0;
    return dalcs_findings_verdict(
        facts->f, "periodic", unique ? DALCS_YES : DALCS_UNDECIDED,
        BG13 "(40); differences that dissipate nothing vanish",
        unique ? "one periodic steady state for periodic sources, which attracts all trajectories"
        : facts->pairs.n_switches > 0 && applies && lure->lossless == 0
            ? "one periodic steady state while the switches rest; not shown when they move"
            : "no unique periodic steady state is shown");
}

enum dalcs_status dalcs_verdict_motion(struct dalcs_facts *facts) {
    if (facts->has_lcs && facts->pairs.n_diodes == 0 && facts->pairs.n_switches == 0 &&
        facts->modes.is_checked) {
        return judge_linear(facts);
    }
    DALCS_TRY(judge_stability(facts));
    return judge_contraction(facts);
}

/* ---- In plain words -------------------------------------------------------------------------- */

static const struct dalcs_verdict *find(const struct dalcs_facts *facts, const char *question) {
    size_t i = 0;
    while (strcmp(facts->f->verdict[i].question, question) != 0) {
        i++;
    }
    return &facts->f->verdict[i];
}

const char *dalcs_facts_summary(const struct dalcs_facts *facts) {
    struct dalcs_arena *arena = facts->f->result;
    static const char *const question[] = {"exists", "unique",      "jumps",
                                           "step",   "convergence", "passive"};
    const struct dalcs_verdict *v[6];
    for (size_t k = 0; k < 6; k++) {
        v[k] = find(facts, question[k]);
    }
    bool exists = v[0]->answer == DALCS_YES;
    bool unique = v[1]->answer == DALCS_YES;
    const char *first =
        exists && unique ? "Exactly one trajectory for every start and source"
        : v[0]->answer == DALCS_CONDITIONAL && unique
            ? dalcs_arena_printf(arena, "At most one trajectory; one exists %s", v[0]->sentence)
        : exists ? "A trajectory for every start and source; that it is the only one is not shown"
        : unique ? "At most one trajectory; that one exists is not shown"
        : v[1]->answer == DALCS_NO
            ? "For some starts and sources there is no trajectory, or more than one"
            : "Existence and uniqueness of a trajectory are not shown";
    const char *given =
        facts->pairs.has_fed_back_switch ? " (for given positions of its switches)" : "";
    return first == NULL
               ? NULL
               : dalcs_arena_printf(arena, "%s%s; %s; %s; %s.%s%s%s", first, given,
                                    v[2]->answer == DALCS_UNDECIDED
                                        ? "whether states jump is not shown"
                                        : v[2]->sentence,
                                    v[3]->answer == DALCS_UNDECIDED && v[3]->sentence[0] == 'u'
                                        ? "the range of solvable steps is not shown"
                                        : v[3]->sentence,
                                    v[4]->sentence, v[5]->answer == DALCS_NO ? " Passive: " : "",
                                    v[5]->answer == DALCS_NO ? v[5]->sentence : "",
                                    v[5]->answer == DALCS_NO ? "." : "");
}
