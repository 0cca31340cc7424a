/* results.h - what a report lists: events, measurements, losses, steps that failed. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_RESULTS_H
#define LIBDALCS_RESULTS_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

/* A diode or switch changed sides. */
struct dalcs_event {
    double time;         /* s; of euler the end of the step that found it */
    const char *element; /* "d1", "s1" */
    bool on;             /* now conducts, or is closed */
};

/* States of one component that changed at once. */
struct dalcs_jump {
    double time; /* s */
    size_t n_states;

    const struct dalcs_jump_state {
        const char *element; /* "c1": V, "l1": A */
        double before, after;
    } * state;

    size_t n_impulses;

    const struct dalcs_impulse {
        const char *element; /* diode or switch */
        bool is_flux;        /* Wb across it, of a diode in reverse; else C through it */
        double value;
    } * impulse;

    double energy_lost; /* J, 1/2 |dx|^2 in the storage metric */
    double source_work; /* J, what the sources delivered in the jump */
};

/* A signal that the circuit does not determine: any value between the bounds belongs to an exact
 * solution. */
struct dalcs_nonunique {
    const char *signal;  /* "i(d1)" */
    double time;         /* s, when it was found first */
    double lower, upper; /* V or A; may be infinite */
    double value;        /* the least-norm choice, which the results have */
    const char *because; /* "d1 parallel to d2" */
};

/* What a .meas gave. */
struct dalcs_measurement {
    const char *name;
    const char
        *step; /* of .step, "r = 500, c = 1e-06", one text for all of a step of an analysis; NULL
                         without */
    bool found;
    double value;        /* in the unit of what was measured; 0 unless found */
    const char *failure; /* why not; NULL when found */
    int n_details;

    struct dalcs_measurement_detail {
        const char *name; /* "from", "to", "at", "with", "targ", "trig", as ngspice prints them */
        double value;
    } detail[2];
};

/* What a .four gave: signal = magnitude[0] + sum of magnitude[k] sin(2 pi k frequency (t - from) +
 * phase[k]) over the periods from `from` to `to`. */
struct dalcs_fourier {
    const char *signal;
    const char *step;   /* as of a measurement */
    double frequency;   /* Hz */
    double from, to;    /* s */
    double thd;         /* harmonics from the second on over the first; not finite without that */
    size_t n_harmonics; /* the constant counted */
    const double *magnitude; /* [n_harmonics] */
    const double *phase;     /* [n_harmonics] degrees */
};

/* What an element took over a window of the run, by voltage from its first node to its second and the current
 * that flows so inside it. */
struct dalcs_element_losses {
    const char *element;
    const char
        *kind; /* "source", "resistor", "winding" (Rser of a coil), "diode", "switch", "coil",
                         "capacitor" */
    double v_average, v_rms, i_average, i_rms; /* V, A; not a number: an rms of an impulse */
    double power;         /* W, the mean of what it takes; what a source delivers is negative */
    double jumps;         /* J of that, at instants when states jumped */
    double stored_change; /* J, of coils and capacitors */
    double switching;     /* J by the tables of .switchloss, besides the circuit's own */
    long n_on, n_off;     /* of diodes and switches: how often they turned on and off */
    long n_clamped;       /* of these, those outside their table, at its edge */
    double frequency;     /* Hz, of a source with a period; else 0 */
    double
        power_factor; /* of a source over whole periods, else not a number; so with the next two */
    double displacement; /* the cosine between the fundamentals of voltage and current */
    double thd; /* rms of what is neither constant nor fundamental, over the fundamental's */
};

/* Where the power went, of a .tran between two times or of all of an orbit. */
struct dalcs_losses {
    const char *step; /* as of a measurement */
    bool of_orbit;    /* .pss; else .tran */
    double from, to;  /* s */
    size_t n_elements;
    const struct dalcs_element_losses *element;
    double sources, resistors, windings, diodes, switches; /* J; the first delivered */
    double jumps;         /* J lost in jumps that no switch or diode carried */
    double stored_change; /* J */
    double balance;       /* J: the sources less all the others */
    double turnover;      /* J: the sum of all that was moved, whatever its sign */
    double switching;     /* J, by tables */
    double input, output; /* W */
    double efficiency;    /* output over input and what switching takes; not a number where neither
                             has a meaning */
    const char *inputs, *outputs; /* which elements these are of */
};

/* A step of .step that failed. */
struct dalcs_failed_step {
    size_t step;        /* from 0 */
    const char *values; /* "r = 500, c = 1e-06" */
    enum dalcs_status status;
    const char *because; /* the sentence of its first error */
};

#endif
