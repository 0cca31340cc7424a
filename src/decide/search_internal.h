/* search_internal.h - what search.c and search_mode.c have in common. Private to src/decide. */
#ifndef DALCS_SEARCH_INTERNAL_H
#define DALCS_SEARCH_INTERNAL_H

#include "search.h"

/* What was seen of errors in another mode, or from another state, does not count. */
void dalcs_search_start_over(struct dalcs_radau_part *part, struct dalcs_search *search, int level);

/* After micro-steps, in the mode that is to be tried. is_off: see dalcs_radau_restart(). */
enum dalcs_status dalcs_search_go_on_from_answer(struct dalcs_radau *r,
                                                 struct dalcs_radau_part *part,
                                                 struct dalcs_search *search,
                                                 bool is_off) DALCS_MUST_CHECK;

/* Asks the circuit. Blocks before this one hold, and keep their mode: nothing in it acts on them. */
enum dalcs_status dalcs_search_ask_from(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                        struct dalcs_search *search, int block) DALCS_MUST_CHECK;

#endif
