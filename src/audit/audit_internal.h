/* audit_internal.h - what the files of src/audit share. */
#ifndef DALCS_AUDIT_INTERNAL_H
#define DALCS_AUDIT_INTERNAL_H

#include "audit.h"

#include <math.h>
#include <stdint.h>

/* Instants of a look: one inside, and both sides of its end. */
enum { AUDIT_LOOK_INSTANTS = 3 };

/* What a stimulus is between two times, as a polynomial. */
enum { AUDIT_COURSE_TERMS = 10 };

struct audit_course {
    double from, to, origin; /* s */
    int n;                   /* terms */
    double term[AUDIT_COURSE_TERMS];
};

/* How all stretches of a part are looked at by screens (watch.h). */
struct audit_watch;

/* A part: its devices and the nodes that they hang on, shorts merged, without ground. */
struct audit_part {
    int n_devices, *device;
    int n_nodes, *node;
    int n_couplings, *coupling;

    struct audit_latches { /* its switches with hysteresis, [n] */
        int n, *device;
        bool *was_closed;
        bool *has_turned; /* where the stretch begins, of those that are asked */
    } latches;

    double tolerance;

    struct audit_floor {     /* of scales */
        double largest_volt; /* V: so far */
        double volt, ampere; /* that every voltage and current is at least held to */
        double levels[2];    /* V, A: the largest that one of its formulas adds up */
        double least, most;  /* S, of its conductances; 0: it has none */
    } floor;

    struct audit_at_hand { /* the stretch that is looked at */
        double step;       /* s */
        double span;       /* s, from where it begins to where it ends; 0: there is none */
        double length;     /* s, of the stretch that was complete last */
        double past;       /* s, of the one before that */
        double lateness;   /* s, that an event may be early by, while its far side is looked at */
        double slope;      /* 1/s: most that a derivative in it may be of what it is of */
        bool is_coarse;
        bool was_coarse,
            past_coarse;  /* the stretch that was complete last, and the one before that */
        bool from_coarse; /* the one before the event that is looked at */
        bool was_undecided,
            past_undecided; /* no position suits some switch in it, and in the one before that */
        bool is_drawn;      /* for a closer look */
        int against; /* a switch that stood against its control over the step before, from 1 on; 0: none */
    } at;

    double asked_at; /* s, of what audit->state.asked has of it; < 0: nothing */
    enum dalcs_side asked_side;

    double cost; /* of one instant, in instructions, about */

    struct audit_sources_in {
        bool smooth;         /* of a smooth function */
        bool formula;        /* one that jumps: in no time it may be anything between */
        bool reader;         /* what acts by a current: H, F, a formula */
        bool voltage_reader; /* E and G */
    } has;

    bool is_restless;    /* it had no operating point to begin with */
    bool has_entered;    /* the state at its last event is in audit->state.before */
    bool is_open;        /* audit->state.before is the end of the stretch that was just left */
    bool was_integrated; /* an interval in it was looked at */
    struct audit_watch *watch;
};

/* Sums over the branches at each node, or of each coil, while a law is checked. */
struct audit_sums {
    double *current;       /* [n_nodes] A that leaves, or C */
    double *scale;         /* [n_nodes] of what was added up */
    double *rounding;      /* [n_nodes] that is in it */
    double volts, amperes; /* ... from the fluxes of coils, and the charges of capacitors */
    double *flux;          /* [n_devices] Wb, of coils */
    double energy, energy_scale, energy_rounding; /* J, or W */
};

struct dalcs_audit {
    const struct dalcs_circuit *circuit;
    struct dalcs_audit_options options;
    struct dalcs_audit_reader reader;

    struct audit_net {
        int n_lambdas;
        int *node_of;     /* [n_nodes] that stands for all that shorts join with it */
        int *owner;       /* [n_nodes] the part that such a node is in; -1: none */
        bool *has_charge; /* [n_nodes] a capacitor hangs on it */
        bool *
            is_read; /* [n_nodes] ground, or a device of a part hangs on it: states have its voltage */
        bool *is_fed;      /* [n_nodes] ground, or a source without a jump at 0 holds it */
        bool *is_held;     /* [n_nodes] likewise, whatever it does */
        bool *is_gated;    /* [n_nodes] such a one that the output of a gate is part of */
        int *first_lambda; /* [n_devices] */
        int *
            part_of; /* [n_nodes] the device that puts a part of a formula out there; -1: none. NULL: there are none */
        bool *
            is_inner; /* [n_devices] such a device that formulas alone read: what they put out is held to its law. NULL */

        struct audit_reads {
            int *first; /* [n_devices + 1] of each device with a formula, parts of formulas too */

            struct audit_read {
                enum dalcs_quantity_kind kind; /* a voltage, a current, a stimulus */
                int index;
            } * of;

            struct audit_number {
                double value, rounding;
            } * lambda; /* [n_lambdas] work of formula_value.c */
        } reads;

        bool *
            is_merged; /* [n_devices] a short whose two nodes are one: no formula reads its current */
        bool *
            is_told; /* [n_devices] a resistor whose current is one of the state: v = R i is a law of it as of a coil */
    } net;

    struct audit_part *part;
    struct audit_course *course; /* [n_stimuli] */

    struct audit_scales {
        double *v, *i, *lambda; /* largest so far */
    } scale;

    struct audit_states {
        struct dalcs_audit_state now, later, shifted; /* work */
        struct dalcs_audit_state
            asked; /* of parts, each at the time that it was asked for last (signals.c) */
        struct dalcs_audit_state before; /* where stretches ended: parts share only ground */
    } state;

    struct audit_sums sums;

    struct audit_crossing {
        int *cluster;   /* [n_nodes] work of crossing.c */
        double *offset; /* [n_nodes] likewise */
        double *stored; /* [n_devices] V, A: of capacitors and coils, before */
        int *tie; /* [n_nodes] impulses.c: whose impulse of voltage it has; 0: ground's, none */
        bool *has_impulse;        /* [n_nodes] likewise */
        bool coils_jump;          /* and E, G or a formula may read the voltage across one */
        bool is_first_try, holds; /* what does not hold is found at the second */

        struct audit_corners {
            const struct dalcs_audit_state *later; /* NULL: corners are read as they are */
            double volts, amperes; /* what rounding makes of what amplifiers put out */
        } corners;
    } crossing;

    struct audit_worst {
        double defect, scale; /* the largest of each, in the law's own unit */
        double time;          /* s, of the defect */
        int part;
        bool
            stays; /* a switch against its control, over whole steps (audit_positions.h): that is the defect */
    } * worst_of[DALCS_AUDIT_N_LAWS], /* [dalcs_audit_n_of] */
        *flux;                        /* [n_devices] of coils, in no time */

    struct audit_coarse {
        double defect, time; /* the worst of all, over its scale, at ends of coarse stretches */
        enum dalcs_audit_law law;
        int index;
    } coarse;

    struct dalcs_audit_summary count; /* of it, what is counted */
    uint64_t seed;

    struct audit_budget {
        double credit, threshold; /* instructions */
        double spent;             /* likewise, by screens since work was earned */
    } budget;

    struct dalcs_arena arena;
};

/* courses.c: the value of a stimulus where its course is not known. */
double audit_course_begin(struct dalcs_audit *audit, int stimulus, double t);

static inline double audit_course_value(const struct audit_course *c, double t) {
    double value = c->term[c->n - 1];
    for (int k = c->n - 2; k >= 0; k--) {
        value = value * (t - c->origin) + c->term[k];
    }
    return value;
}

/* At a time that is no edge. */
static inline double audit_stimulus_at(struct dalcs_audit *audit, int stimulus, double t) {
    const struct audit_course *c = &audit->course[stimulus];
    return c->from <= t && t <= c->to ? audit_course_value(c, t)
                                      : audit_course_begin(audit, stimulus, t);
}

/* budget.c: instructions of an instant, about. */
double audit_instant_work(const struct audit_part *part);

/* Is it this stretch's turn? Which ones are is drawn, so that no period of the circuit hides any. */
bool audit_is_drawn(struct dalcs_audit *audit, double cost);

/* audit.c: a stretch that was put off is asked, and looked at where it has to be. */
void audit_look_again(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* 0 <= draw < 1, the same in each run. */
static inline double audit_draw(struct dalcs_audit *audit) {
    audit->seed ^= audit->seed << 13; /* Marsaglia, Xorshift RNGs, J. Stat. Soft. 8 (2003) */
    audit->seed ^= audit->seed >> 7;
    audit->seed ^= audit->seed << 17;
    return (double)(audit->seed >> 11) * 0x1p-53;
}

/* Of the work of the run, the part that closer looks may cost in any case, however much screens take. */
#define AUDIT_LEAST_SHARE 0.005

/* What closer looks may cost more, now that the run has done so much and screens have spent some. */
static inline double audit_earned(const struct dalcs_audit *audit, double work, double spent) {
    const double left = audit->options.share * work - spent;
    const double least = AUDIT_LEAST_SHARE * work;
    return left > least ? left : least;
}

/* Where nothing is, a value is as much as there is. */
static inline double audit_ratio(double value, double scale) {
    return value == 0.0 ? 0.0 : value / fmax(scale, 0x1p-1022);
}

/* Sums of a dozen terms that were each rounded once or twice. */
#define AUDIT_ROUNDING (16.0 * 0x1p-52)

/* An event is within 1e-11 of the stop time, and so is the start of a run: so many resolutions, which are 2^-50 of it. */
#define AUDIT_PROMISED 0x1p13

static inline double audit_voltage(const struct dalcs_audit_state *s,
                                   const struct dalcs_device *d) {
    return s->v[d->node[0]] - s->v[d->node[1]];
}

/* Times in a stretch are known to a rounding of t, over its length that is what a value in it may be off by where it
 * changes by its whole scale: it has to be less than the tolerance. Of a length they are up to a time, s. */
static inline double audit_told_until(const struct audit_part *part, double length) {
    return length * part->tolerance / (4.0 * 0x1p-52);
}

static inline bool audit_can_tell_times(const struct audit_part *part, double length, double to) {
    return to < audit_told_until(part, length);
}

/* What a voltage between two nodes is held to. */
static inline double audit_volts(const struct dalcs_audit *audit, const struct audit_part *part,
                                 int a, int b) {
    return fmax(fmax(audit->scale.v[a], audit->scale.v[b]), part->floor.volt);
}

static inline double audit_amperes(const struct dalcs_audit *audit, const struct audit_part *part,
                                   int device) {
    return fmax(audit->scale.i[device], part->floor.ampere);
}

/* The current of a branch that is no capacitor, from the device's own law where that gives it. */
double audit_current(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                     int device);

/* parts.c: parts, and room for all, in audit->arena. */
enum dalcs_status audit_set_up(struct dalcs_audit *audit) DALCS_MUST_CHECK;

/* Takes those of a device into floor->least and floor->most. */
void audit_see_conductances(struct audit_floor *floor, const struct dalcs_circuit *c,
                            const struct dalcs_device *d);

/* A defect and its scale, in one unit for each law and index. What rounding explains, and what is allowed
 * besides, is taken off. */
void audit_find(struct dalcs_audit *audit, const struct audit_part *part, enum dalcs_audit_law law,
                int index, double defect, double scale, double time);

/* findings.c: what a node gained; put off where the jump is asked again. */
void audit_find_charge(struct dalcs_audit *audit, const struct audit_part *part, int node,
                       double defect, double scale, double time);

/* The same of the flux of a coil across an instant. It has a scale of its own: what fluxes over an interval are held to
 * grows with that, and with the largest voltage that has ever been: beside a spike of 1e10 V any jump would be nothing. */
void audit_find_flux(struct dalcs_audit *audit, const struct audit_part *part, int device,
                     double defect, double scale, double time);

/* signals.c: a signal at a state, what it is held to, and what rounding made of it. It can be read. */
struct audit_signal {
    double scale, rounding;
};

double audit_signal_value(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                          int index, struct audit_signal *of);

/* Gauss' rule with five nodes on (0, 1), exact for polynomials up to degree 9 (Abramowitz and Stegun, 25.4.29). */
enum { AUDIT_GAUSS = 5 };

extern const double audit_gauss_node[AUDIT_GAUSS], audit_gauss_weight[AUDIT_GAUSS];

/* laws.c */
void audit_check_branch(struct dalcs_audit *audit, struct audit_part *part,
                        const struct dalcs_audit_state *s, int device);

/* kirchhoff.c: what leaves each node of a part, audit->sums, with its scale and rounding. */
void audit_sum_currents(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s);

/* ... what of that comes from storage: audit->sums.volts and amperes. */
void audit_round_storage(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s);

/* ... and what all nodes that ideal branches join with one have of that. Overwrites audit->crossing.cluster. */
double audit_rounding_around(struct dalcs_audit *audit, const struct audit_part *part,
                             const struct dalcs_audit_state *s, int node);

/* V and A that the two branches of a diode are held to. */
void audit_diode_scale(const struct dalcs_audit *audit, const struct audit_part *part, int device,
                       double scale[2]);

/* kirchhoff.c: all that holds at one time. */
void audit_check_instant(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s);

/* Raises scales to what the state has. */
void audit_note_scales(struct dalcs_audit *audit, struct audit_part *part,
                       const struct dalcs_audit_state *s);

/* Wb: what the currents that make a coil's flux are held to. */
double audit_flux_scale(const struct dalcs_audit *audit, const struct audit_part *part, int device);

/* intervals.c: what holds between two times in one stretch. */
void audit_check_interval(struct dalcs_audit *audit, struct audit_part *part, double from,
                          double to);

/* start.c: does the part begin as the netlist says? `stored`: of the step that begins there; NULL: there is none. */
void audit_check_start(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *first,
                       const struct dalcs_audit_polynomials *stored);

#endif
