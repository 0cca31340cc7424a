/* facts.h - what is known of one part while its verdicts are written. */
#ifndef DALCS_FACTS_H
#define DALCS_FACTS_H

#include "brogliato.h"
#include "cones.h"
#include "findings.h"
#include "lure.h"
#include "modes.h"
#include "motion.h"
#include "passivity.h"
#include "relay.h"

/* Dense matrices up to this many equations and pairs; every condition of Brogliato 2022 up to as many
 * algebraic unknowns or pairs. */
enum { DALCS_MOST_DENSE = 2200, DALCS_MOST_ONE_STEP = 120 };

struct dalcs_facts {
    struct dalcs_findings *f;
    const struct dalcs_system *system;
    const struct dalcs_power *power; /* or NULL */
    const bool *jumps;               /* or NULL */
    double h;
    enum dalcs_hold *hold; /* [n_pairs] switches as they start */

    struct {
        int n_diodes, n_switches;
        bool has_fed_back_switch; /* one that the circuit itself commands */
    } pairs;
    struct dalcs_cones cones;
    const char *obstacle; /* why matrices are not looked at, when they are not */
    bool is_dense;        /* what follows is there */
    struct dalcs_blocks blocks;
    struct dalcs_lcs lcs;
    bool has_lcs; /* no obstacle */
    struct dalcs_lure lure;
    struct dalcs_modes
        modes;               /* of parts that are not passive by their elements, or have no diode */
    bool steps_are_monotone; /* A = 0 (rcp.h) */
    struct dalcs_relays relays;
    struct dalcs_giving giving;

    struct {
        bool is_there;
        struct dalcs_brogliato of;
    } brogliato;
    enum dalcs_answer passive;
};

/* Is there a mode that bounds the step? */
static inline bool dalcs_has_limit(const struct dalcs_facts *facts) {
    return facts->modes.is_checked && facts->modes.fastest.value[0] > 0.0;
}

/* All pairs are relays that well-posedness is known of whatever the rest does. */
static inline bool dalcs_are_relays(const struct dalcs_facts *facts) {
    return facts->relays.n > 0 && facts->relays.is_all &&
           (facts->relays.is_P || (facts->relays.is_coupled && facts->lure.can_shift));
}

/* Each adds one verdict or two. */
enum dalcs_status dalcs_verdict_passive(struct dalcs_facts *facts) DALCS_MUST_CHECK;
enum dalcs_status dalcs_verdict_exists(struct dalcs_facts *facts) DALCS_MUST_CHECK;
enum dalcs_status dalcs_verdict_unique(struct dalcs_facts *facts) DALCS_MUST_CHECK;
enum dalcs_status dalcs_verdict_jumps(struct dalcs_facts *facts) DALCS_MUST_CHECK;
enum dalcs_status dalcs_verdict_step(struct dalcs_facts *facts) DALCS_MUST_CHECK;
enum dalcs_status dalcs_verdict_motion(struct dalcs_facts *facts) DALCS_MUST_CHECK;

/* Plain words from the verdicts; NULL when out of memory. */
const char *dalcs_facts_summary(const struct dalcs_facts *facts);

#endif
