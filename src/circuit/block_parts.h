/* block_parts.h - what analog code models are made of. */
#ifndef DALCS_BLOCK_PARTS_H
#define DALCS_BLOCK_PARTS_H

#include "behaviour.h"
#include "block.h"
#include "formula_writer.h"
#include "model_cards.h"

/* A device from a to b; what NULL: it has the element's name. NULL: out of memory. */
struct dalcs_device *dalcs_block_add(const struct dalcs_block_card *c, enum dalcs_device_kind kind,
                                     const char *what, int a, int b);
/* A V or I source of a number. */
bool dalcs_block_add_constant(const struct dalcs_block_card *c, enum dalcs_device_kind kind,
                              const char *what, const int *node, double value);
/* Of a V or I source. */
void dalcs_block_add_stimulus(const struct dalcs_block_card *c, struct dalcs_device *device,
                              const struct dalcs_stimulus *stimulus);

/* What keeps an output on one side of a level. */
struct dalcs_block_clamp {
    bool is_upper;
    double level; /* V */
    double ohms;
};

/* Is it a level, or a number so large that it says there is none? */
bool dalcs_block_is_level(double level);
/* An ideal diode that conducts where node[0] is beyond a level against node[1]; a level of 1e30 V and more is none. */
bool dalcs_block_add_clamp(const struct dalcs_block_card *c, const int *node,
                           const struct dalcs_block_clamp *clamp);
/* A resistor or capacitor between two nodes, if its parameter is given and not 0. */
bool dalcs_block_add_across(const struct dalcs_block_card *c, const int *node,
                            enum dalcs_device_kind kind, const struct dalcs_parameter *p);
/* An E or G source, a switch: the voltage of a port times a gain. */
void dalcs_block_control(struct dalcs_device *device, const struct dalcs_block_end *by,
                         double gain);
/* A model of these parameters, ports that are all nodes, and as many. */
bool dalcs_block_check(const struct dalcs_block_card *c, const char *const *names, size_t n,
                       int ports, const char *usage);

/* Without knots yet; without room where memory is out. */
struct dalcs_piecewise dalcs_block_make_table(const struct dalcs_block_card *c, int n);
void dalcs_block_set_knot(struct dalcs_piecewise *table, int k, double x, double y);
/* The last port as the table's function of a voltage. */
void dalcs_block_add_table(const struct dalcs_block_card *c, const struct dalcs_block_end *by,
                           const struct dalcs_piecewise *table);
/* From parameters that are lists: straight lines, which the first and the last go on. False: an error was reported. */
bool dalcs_block_read_table(const struct dalcs_block_card *c, const char *x_name,
                            const char *y_name, struct dalcs_piecewise *table);
/* out_lower_limit and out_upper_limit; those that are not given are none. */
bool dalcs_block_read_limits(const struct dalcs_block_card *c, double *low, double *high);

/* gain (v(input) + offset) */
const struct dalcs_formula *dalcs_block_line(struct dalcs_formula_writer *w,
                                             const struct dalcs_block_end *input, double offset,
                                             double gain);
/* A formula as the voltage of a port. */
void dalcs_block_put_out(const struct dalcs_block_card *c, struct dalcs_formula_writer *w,
                         const struct dalcs_formula *what, const struct dalcs_block_end *out);

/* ---- block_state.c -------------------------------------------------------------------------------- */

/* Two branches of one shape. The output is continuous where the input passes from one to the other, for both are at the
 * same limit there. */
void dalcs_block_parse_hysteresis(const struct dalcs_block_card *c);

void dalcs_block_parse_integrator(const struct dalcs_block_card *c);

void dalcs_block_parse_slew(const struct dalcs_block_card *c);

void dalcs_block_parse_derivative(const struct dalcs_block_card *c);

#endif
