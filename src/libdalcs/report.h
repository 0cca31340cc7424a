/* report.h - the report of a run, and documents as JSON. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_REPORT_H
#define LIBDALCS_REPORT_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

/* What a run did. Strings and arrays are borrowed from the session and live until its next run. */
struct dalcs_report {
    const char *netlist; /* path or name */
    const char *title;
    const char *method; /* as asked for, or the default */
    double tolerance;   /* of radau and auto, else 0 */
    double step;        /* s, the fixed step of .tran; 0 when there was none */
    double stop;        /* s */
    size_t n_components;

    const struct dalcs_component_method {
        const char *method;  /* "euler", "radau", or "algebraic": no memory, solved where wanted */
        int stages;          /* of radau, else 1 */
        const char *because; /* "very small, held to 1e-9"; NULL: asked for */
    } * component;           /* [n_components], .tran only */

    struct {
        int nodes, x, z, lambda, switches, components;
        int corners; /* of the lambdas, those of sources with a formula */
    } size;

    struct {
        long steps;          /* accepted time steps, over all components */
        long rejected;       /* steps repeated with a smaller one */
        long restarts;       /* pairs of micro-steps that decided a mode or a jump */
        long euler_steps;    /* steps where radau fell back to implicit Euler */
        long periodic_steps; /* steps that were those of a period before */
        long leapt_steps;    /* steps in periods that were taken as one */
        long osnsp;          /* one-step problems solved, over all components */
        long pivots;         /* mode changes tried */
        long factorizations; /* of KLU and LAPACK */
        long cache_hits;
        long singular; /* problems in a singular mode, answered by the least-norm solution */
        double cpu_s, wall_s;
    } work;

    struct {
        double worst;      /* largest scaled residual of any accepted step */
        double time;       /* s */
        const char *where; /* "KCL at out", "branch v1", "complementarity of d1", "stages" */
        double wrong_sign; /* of radau: most negative current or reverse voltage of a diode, over
                              the largest current or voltage; where one has just changed sides it may
                              be as large as the tolerance */
    } certificate;

    /* Of .tran: laws of the netlist's devices, checked on the finished waveform; of .op and .dc at rest. */
    struct {
        const char *mode; /* "sample" or "full"; NULL: nothing was audited */
        long instants;    /* at which laws were checked, operating points among them */
        long segments;    /* between two events or ends of steps, of all parts; 0: points alone */
        long audited;     /* of them, those that were looked into */
        long screened;    /* those of which all linear laws were checked at once */
        long positions;   /* of switches, compared with their controls */
        double worst, allowed; /* the worst defect over its scale, and what it was held to */
        double time;           /* s, of that */
        const char *where;     /* "d1", "i(d1)", "KCL at out", "position of s1", "Tellegen" */
        size_t n_laws;

        const struct dalcs_audited {
            const char *law;
            double defect; /* the worst, over its scale */
            double time;   /* s */
        } * law;           /* [n_laws] whose defect is not 0 */
    } audit;

    size_t n_states;
    const char *const *state_name; /* [n_states] element names of capacitors and inductors */
    const double *start;           /* [n_states] just after t = 0: V, A */
    const double *final;           /* [n_states] */
    size_t n_events, n_events_dropped;
    const struct dalcs_event *event;
    size_t n_jumps, n_jumps_dropped;
    const struct dalcs_jump *jump;
    size_t n_nonunique; /* each signal once */
    const struct dalcs_nonunique *nonunique;

    size_t n_measurements; /* .meas of the analyses that were run, in the netlist's order; of all
                              steps of .step */
    const struct dalcs_measurement *measurement;
    size_t n_fourier;
    const struct dalcs_fourier *fourier;
    size_t n_losses; /* one for each .pss and .tran that was asked for its losses */
    const struct dalcs_losses *losses;

    /* J, over .tran: sources = resistors + diodes + jumps + stored_change + method + balance */
    struct {
        bool present;
        double sources;       /* delivered by V and I, and by controlled sources */
        double resistors;     /* dissipated; in switches and in Roff of diodes as well */
        double diodes;        /* in Vfwd, Ron and breakdown */
        double jumps;         /* lost when states jumped */
        double stored_change; /* in capacitors and inductors, end minus start */
        double method;        /* dissipated by the method: no circuit does */
        double balance;       /* left side minus right side: rounding; if it is more than that, or
                                 if the method of radau is more than its tolerance explains, the run
                                 ends with DALCS_E_INTERNAL */
    } energy;

    size_t n_sides; /* of .ac: where each diode and switch stands at the operating point */

    const struct dalcs_side_taken {
        const char *element;
        bool on;         /* conducts, or is closed */
        bool degenerate; /* a diode with neither current nor voltage: either side fits */
    } * side;            /* [n_sides] */

    struct {
        bool present;
        double time;      /* s */
        const char *kind; /* "loop", "cutset", "mode": no mode of a circuit that is not passive,
                             "equations": those of its elements contradict each other, or
                             "derivative": states would jump by the derivative of an impulse */
        size_t n_elements;
        const char *const *element; /* a loop's in its order, from the source that drives on */
        const char *because;        /* the sentence of the message */
    } infeasible;

    /* Of .pss (doc/steady.md). */
    struct {
        bool present;
        double period; /* s */
        int newton, bursts, leaps;
        long periods;    /* that the search has run */
        double residual; /* by how much a period misses where it began, over each state's scale */
        double distance; /* how far the steady state is from there, by one more Newton step */
        double defect;   /* the same as residual of the period that was written */
        bool exact;      /* the multipliers are: no step of implicit Euler, nothing slides */
        bool stable;
        const char *verdict;
        size_t
            n_multipliers; /* the largest first; those of states that last no period are left out */

        const struct dalcs_floquet {
            double re, im;
            const char *state; /* "v(c1)" which has most of it */
        } * multiplier;

        const double *state; /* [n_states] at its beginning, before any edge there */
        size_t n_conserved;  /* quantities with a multiplier of 1, "v(c2) - 0.5 v(c1)" */
        const char *const *conserved;
        size_t n_signals;

        const struct dalcs_steady_signal {
            const char *name;    /* "v(out)" */
            double average, rms; /* not a number: one of an impulse */
        } * signal;              /* [n_signals] over the period, exact */

        struct {
            double period; /* s; 0: of two periods of the sources none was found, or looked for */
            bool stable;
            size_t n_multipliers;
            const struct dalcs_floquet *multiplier; /* over both periods */
        } doubled; /* where a multiplier below -1 says that a run leaves the orbit for such a one */

        struct {
            const char *
                kind; /* "orbit", "quasi-periodic", "chaos"; NULL: not known, or the orbit is stable */
            int periods;   /* of the sources; 0: of no orbit */
            double period; /* s; likewise */
            double growth; /* of a small difference: in each period; of an orbit in all of them */
        } attractor;       /* what a run comes to that leaves an unstable orbit */

        bool self_oscillating; /* no source has a period: the circuit's own was found */
        double
            flow; /* its multiplier along the orbit, 1 but for rounding, which is none of those above */
    } steady;

    /* Of .env. */
    struct {
        bool present;
        double period;         /* s, of the sources */
        long periods;          /* from the start to the end */
        long run;              /* of them, those that were run to find the others */
        long leaps, rejected;  /* over periods that were not; tried, but not accurate */
        double worst, allowed; /* the largest error of a leap, over each state's largest value */
    } envelope;

    /* Of .ac around it (doc/bode.md). */
    struct {
        bool present;
        double period; /* s, of the orbit */
        int sideband;  /* rows are of the components so many orbit's frequencies higher */
        bool
            exact; /* no step of implicit Euler, nothing slides, no commands at one time that move apart */
        double tail; /* what polynomials of its pieces leave out at most, over what they are of */
        const char *loop;    /* the source in the loop; NULL: none was asked for */
        bool loop_is_loaded; /* by a voltage and a current */
        size_t n_crossovers, n_reversals;

        const struct dalcs_margin {
            double frequency; /* Hz */
            double margin;    /* deg where the gain is 1, dB where the phase is 180 deg */
        } * crossover,        /* [n_crossovers] */
            *reversal;        /* [n_reversals] */
    } response;

    /* Of .sens behind .pss: what the measurements of the orbit change by with a value (doc/steady.md). */
    struct {
        bool present;
        size_t n_parameters, n_results;

        const struct dalcs_sensitivity_parameter {
            const char *name; /* "l1", "duty", "dmod(vfwd)" */
            double value;
        } * parameter; /* [n_parameters] */

        const struct dalcs_sensitivity_result {
            const char *name; /* "v(out)", "ripple" */
            const char
                *kind; /* "average", "rms", "measurement", "magnitude", "phase", "thd", "period" */
            int harmonic; /* of magnitude and phase */
            double value;
            const double *derivative; /* [n_parameters] by the value; not a number: there is none */
        } * result;                   /* [n_results] */
    } sensitivity;

    /* .wcase: first all in the middle, then each tolerance at its ends alone, then all of them where these say that
     * each measurement is smallest and largest, and all corners where these are few. */
    struct {
        bool present, has_corners;
        size_t n_parameters, n_results, n_runs, n_failed;

        const struct dalcs_worst_case_parameter {
            const char *name;          /* "r1", "d1(vfwd)", "lot(rb)" */
            double low, nominal, high; /* values; -1, 0 and 1 of what has no value of its own */
        } * parameter;                 /* [n_parameters] */

        const struct dalcs_worst_case_result {
            const char *name;               /* of .meas */
            size_t smallest, largest;       /* runs */
            const double *at_low, *at_high; /* [n_parameters] with this one there alone */
        } * result;                         /* [n_results] */

        const struct dalcs_worst_case_run {
            const signed char *place; /* [n_parameters] -1: low, 0: nominal, 1: high */
            const double *value;      /* [n_results] NaN: it could not be measured */
            const char *error;        /* NULL: there is none */
        } * run;                      /* [n_runs] */
    } worst_case;

    size_t n_steps, n_failed_steps; /* of .step, 0 without; of those that were asked for */
    const struct dalcs_failed_step *failed_step; /* each once; all other steps were run */

    long frequencies; /* of .ac, at which laws were checked: beside the instants of `audit` */
    long
        unjudged; /* positions of switches where the waveform is coarse: beside the positions of `audit` */

    /* .tf, by the names that its plot has. An impedance may be infinite. */
    struct {
        bool present;
        const char
            *name[3]; /* "transfer_function", "output_impedance_at_v(out)", "v1#input_impedance" */
        double value[3];
    } transfer;
};

/* Valid after dalcs_session_run, whatever its status but DALCS_E_NOMEM; NULL before. */
const struct dalcs_report *dalcs_session_report(const struct dalcs_session *session);

/* One measurement of the last run's report, for languages that do not read this header; NULL when index is
 * too large. */
const struct dalcs_measurement *dalcs_session_measurement(const struct dalcs_session *session,
                                                          size_t index);

/* Texts that belong to the session and live until the next of them. The report of the last run, by
 * doc/report.schema.json; DALCS_E_OPTION: there is none. */
enum dalcs_status dalcs_session_report_json(struct dalcs_session *session,
                                            const char **json) DALCS_MUST_CHECK;

/* What dalcs_session_check says, by doc/check.schema.json. */
enum dalcs_status dalcs_session_check_json(struct dalcs_session *session, double step,
                                           const char **json) DALCS_MUST_CHECK;

/* What dalcs_session_equations writes as DALCS_EQUATIONS_JSON. */
enum dalcs_status dalcs_session_equations_json(struct dalcs_session *session,
                                               enum dalcs_equations_form form, double step,
                                               const char **json) DALCS_MUST_CHECK;

#endif
