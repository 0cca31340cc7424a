/* response_internal.h - what the files about small signals, src/audit/response*.c, share. */
#ifndef DALCS_RESPONSE_INTERNAL_H
#define DALCS_RESPONSE_INTERNAL_H

#include "response.h"

#include "rounding.h"

#include <math.h>

/* A line of a diode or a switch, p u = q i. */
struct response_line {
    double p, q;
};

enum { RESPONSE_MOST_LINES = 3 };

/* What a device may be for small signals, by its operating point. */
struct response_lines {
    int n;
    struct response_line line[RESPONSE_MOST_LINES];
    double *slope; /* [n_pairs] of a formula: d lambda by its argument; NAN: it is at a corner */
    double gradient
        [2]
        [3]; /* of a smooth function: the least and the largest where its arguments may be; at them */
};

struct response_node {
    double complex sum;
    double scale, size;
    bool is_open; /* a current is not known, or a device is not there */
};

/* What a state gains across an event beside what the lateness makes of it. */
struct response_gain {
    double complex off;
    double allowed;
};

/* A sum, the sizes of its terms, and what these are sums of, which rounding goes by. */
struct response_sum {
    double complex value;
    double scale, size;
};

/* Between the modulus and 1.42 times that, for a third of what that takes. */
static inline double response_magnitude(double complex x) {
    return fabs(creal(x)) + fabs(cimag(x));
}

/* A straight one. */
static inline bool response_is_coil(const struct dalcs_response_audit *a, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    return a->of.are_there[device] && d->kind == DALCS_INDUCTOR && !d->is_storage;
}

/* What a voltage is known by: one within the rounding of the largest is not known at all. */
static inline double response_size(const struct dalcs_response_audit *a, double complex v) {
    const double size = response_magnitude(v);
    return size > a->rounding * a->volts ? size : size / a->rounding;
}

/* ---- response_scales.c ---- */

/* The largest of all, by which rounding that is carried from one law to others is measured. */
void response_find_largest(struct dalcs_response_audit *a, const struct dalcs_response_values *is);

/* The same of small signals around an orbit, so far. */
void response_find_small(struct dalcs_response_audit *a, const struct dalcs_response_values *is);

/* ---- response.c ---- */

/* A law was asked. */
void response_found(struct dalcs_response_audit *a, enum dalcs_response_law law, int index,
                    double defect, double allowed);

/* ---- response_charges.c ---- */

/* Each node is a set of its own, and nothing is summed. */
void response_part_nodes(struct dalcs_response_audit *a);

/* Does something without resistance close at the event? */
bool response_may_join(const struct dalcs_response_audit *a, const struct dalcs_response_event *e);

/* Of capacitors: the charge of nodes that hang together stays what it is. gain: [n_devices]. */
void response_check_charges(struct dalcs_response_audit *a, const struct dalcs_response_event *e,
                            const struct response_gain *gain);

/* ---- response_fluxes.c ---- */

/* Does something open at the event that is a cut then? */
bool response_may_part(const struct dalcs_response_audit *a, const struct dalcs_response_event *e);

/* Of coils: the flux of loops without an impulse of voltage stays what it is. gain: [n_devices]. */
void response_check_fluxes(struct dalcs_response_audit *a, const struct dalcs_response_event *e,
                           const struct response_gain *gain);

/* ---- response_lines.c ---- */

/* Of all devices at the operating point. */
enum dalcs_status response_find_lines(struct dalcs_response_audit *a,
                                      const struct dalcs_response_values *at) DALCS_MUST_CHECK;

/* A diode or a switch. */
bool response_is_two_sided(const struct dalcs_device *d);

/* What a line leaves free: any current, without a voltage, or any voltage, without a current. */
enum response_freedom { RESPONSE_WIRE, RESPONSE_CUT };

/* May a diode or a switch be on such a line behind the event, by its voltage, its current and its control in the orbit? */
bool response_may_be_free(const struct dalcs_response_audit *a,
                          const struct dalcs_response_event *e, int device,
                          enum response_freedom freedom);

/* ---- response_formula.c ---- */

/* Of a device with a behaviour. */
enum dalcs_status response_find_slopes(struct dalcs_response_audit *a,
                                       const struct dalcs_response_values *at,
                                       int device) DALCS_MUST_CHECK;

/* What it puts out, with doubt: an error beside that of the tolerance; false: it is at a corner. */
bool response_formula(struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                      int device, struct response_sum *output, double *doubt);

#endif
