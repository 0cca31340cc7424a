/* logic_outputs.h - what the outputs of gates and samples show, in the stimuli of the circuit. */
#ifndef DALCS_LOGIC_OUTPUTS_H
#define DALCS_LOGIC_OUTPUTS_H

#include "logic_run.h"

struct dalcs_logic_pin;

/* Gate k at rest. *changed: it showed something else. */
enum dalcs_status dalcs_logic_output_start(struct dalcs_logic_run *l, int k,
                                           bool *changed) DALCS_MUST_CHECK;

/* What gate k has decided, from t on. */
enum dalcs_status dalcs_logic_output_show(struct dalcs_logic_run *l, int k,
                                          double t) DALCS_MUST_CHECK;

/* An output at the start of a run that goes on from another one: at `value`, and on its way from there if the gate shows
 * another level. */
enum dalcs_status dalcs_logic_output_restore(struct dalcs_logic_run *l,
                                             const struct dalcs_logic_pin *pin,
                                             double value) DALCS_MUST_CHECK;

/* What was given from outside, at the start of a run. */
enum dalcs_status dalcs_logic_inputs_start(struct dalcs_logic_run *l) DALCS_MUST_CHECK;

/* The same from t on; *acts becomes true where it is another value. */
enum dalcs_status dalcs_logic_inputs_show(struct dalcs_logic_run *l, double t,
                                          bool *acts) DALCS_MUST_CHECK;

/* Which components each stimulus acts on, and room for what changes. What is not complete is finished, too. */
enum dalcs_status dalcs_logic_effect_setup(struct dalcs_logic_run *l) DALCS_MUST_CHECK;
void dalcs_logic_effect_finish(struct dalcs_logic_effect *effect);

/* Which components have to be looked at before gates decide. Behind the places of comparators. */
enum dalcs_status dalcs_logic_effect_find_readers(struct dalcs_logic_run *l) DALCS_MUST_CHECK;

/* Nothing has changed; a stimulus has. */
void dalcs_logic_effect_begin(struct dalcs_logic_run *l);
void dalcs_logic_effect_note(struct dalcs_logic_run *l, int stimulus);

#endif
