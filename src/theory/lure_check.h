/* lure_check.h - what the conditions of lure.h are checked with. */
#ifndef DALCS_LURE_CHECK_H
#define DALCS_LURE_CHECK_H

#include "lure.h"

/* Where conditions come from. */
#define BT10 "Brogliato and Thibault 2010, "
#define BG09 "Brogliato and Goeleven 2009, "
#define BG13 "Brogliato and Goeleven 2013, "

struct dalcs_lure_check {
    struct dalcs_findings *f;
    const struct dalcs_lcs *l;
    const struct dalcs_cones *cones;
    struct dalcs_lure *found;
    double D_least;
};

/* Dissipation: how fast motions part or contract in the energy and, where P B = C', in P. */
enum dalcs_status dalcs_lure_check_dissipation(struct dalcs_lure_check *c,
                                               const struct dalcs_matrix *P) DALCS_MUST_CHECK;

#endif
