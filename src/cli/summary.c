/* summary.c - the run in a few lines: the circuit, the work, the proof, energies, jumps. */
#include "summary.h"

#include "method_text.h"
#include "quantity.h"

#include <math.h>
#include <string.h>

enum { MAX_JUMPS = 5, MAX_PARTS = 6, MAX_METHODS = 4, DIGITS = 4 };

static const char *plural(long n) {
    return n == 1 ? "" : "s";
}

static void write_size(FILE *out, const struct dalcs_report *report) {
    const char *pairs = report->size.corners > 0 ? "pair" : "diode";
    fprintf(out, "  circuit   %d node%s, %d state%s (x), %d algebraic (z), %d %s%s (lambda)",
            report->size.nodes, plural(report->size.nodes), report->size.x, plural(report->size.x),
            report->size.z, report->size.lambda, pairs, plural(report->size.lambda));
    if (report->size.switches > 0) {
        fprintf(out, ", %d switch%s", report->size.switches,
                report->size.switches == 1 ? "" : "es");
    }
    if (report->size.components > 1) {
        fprintf(out, ", %d components", report->size.components);
    }
    fputc('\n', out);
}

static bool same_method(const struct dalcs_component_method *a,
                        const struct dalcs_component_method *b) {
    const char *why_a = a->because ? a->because : "", *why_b = b->because ? b->because : "";
    return strcmp(a->method, b->method) == 0 && a->stages == b->stages && strcmp(why_a, why_b) == 0;
}

/* Was the method left to the program? */
static bool is_chosen(const struct dalcs_report *report) {
    return report->method && strcmp(report->method, "auto") == 0;
}

/* "radau, 5 stages in 250 components (tolerance 1e-06)"; the number of components only where there are several. */
static void write_group(FILE *out, const struct dalcs_report *report,
                        const struct dalcs_component_method *method) {
    char text[DALCS_METHOD_TEXT_SIZE];
    size_t n = 0;
    for (size_t k = 0; k < report->n_components; k++) {
        n += same_method(method, &report->component[k]) ? 1 : 0;
    }
    fputs(dalcs_method_text(text, method), out);
    if (n < report->n_components || (is_chosen(report) && n > 1)) {
        fprintf(out, " in %zu component%s", n, plural((long)n));
    }
    if (method->because) {
        fprintf(out, " (%s)", method->because);
    } else if (report->step == 0.0 && dalcs_method_has_stages(method->method)) {
        fprintf(out, " (tolerance %g)", report->tolerance);
    }
}

/* Equal components once. */
static void write_groups(FILE *out, const struct dalcs_report *report) {
    size_t n_groups = 0;
    for (size_t k = 0; k < report->n_components; k++) {
        bool seen = false;
        for (size_t j = 0; j < k && !seen; j++) {
            seen = same_method(&report->component[j], &report->component[k]);
        }
        if (seen) {
            continue;
        }
        if (n_groups++ == MAX_METHODS) {
            fputs("; ...", out);
            return;
        }
        fputs(n_groups > 1 ? "; " : "", out);
        write_group(out, report, &report->component[k]);
    }
}

/* What was asked for, what was taken, and how often. Nothing without .tran. */
static void write_method(FILE *out, const struct dalcs_report *report) {
    if (report->n_components == 0) {
        return;
    }
    char text[DALCS_QUANTITY_SIZE];
    fprintf(out, "  method    %s", is_chosen(report) ? "auto: " : "");
    write_groups(out, report);
    if (report->step > 0.0) {
        fprintf(out, ", step %s", dalcs_quantity_write(text, report->step, "s", DIGITS));
    }
    fprintf(out, ": %ld step%s", report->work.steps, plural(report->work.steps));
    if (report->work.rejected > 0) {
        fprintf(out, ", %ld rejected", report->work.rejected);
    }
    if (report->work.restarts > 0) {
        fprintf(out, ", %ld restart%s", report->work.restarts, plural(report->work.restarts));
    }
    if (report->work.euler_steps > 0) {
        fprintf(out, ", %ld by euler", report->work.euler_steps);
    }
    if (report->work.periodic_steps > 0) {
        fprintf(out, ", %ld as a period before", report->work.periodic_steps);
    }
    if (report->work.leapt_steps > 0) {
        fprintf(out, ", %ld in whole periods", report->work.leapt_steps);
    }
    fputc('\n', out);
}

static void write_work(FILE *out, const struct dalcs_report *report) {
    char text[DALCS_QUANTITY_SIZE];
    fprintf(out, "  work      %ld one-step problem%s, %ld pivot%s, %ld factorisation%s",
            report->work.osnsp, plural(report->work.osnsp), report->work.pivots,
            plural(report->work.pivots), report->work.factorizations,
            plural(report->work.factorizations));
    fprintf(out, ", %ld cache hit%s", report->work.cache_hits, plural(report->work.cache_hits));
    if (report->work.singular > 0) {
        fprintf(out, ", %ld in a singular mode", report->work.singular);
    }
    fprintf(out, "\n  time      %s cpu", dalcs_quantity_write(text, report->work.cpu_s, "s", 3));
    fprintf(out, ", %s wall\n", dalcs_quantity_write(text, report->work.wall_s, "s", 3));
}

/* "proof     audited at 4812 instants: worst defect 3.1e-10 of d1 at 1.24 ms; 511 switch positions right" */
static void write_audit(FILE *out, const struct dalcs_report *report) {
    char text[DALCS_QUANTITY_SIZE];
    const long instants = report->audit.screened + report->audit.instants; /* sums, and each law */
    fprintf(out, "  proof     audited at %ld %s%s", instants,
            report->audit.segments > 0 ? "instant" : "operating point", plural(instants));
    if (report->frequencies > 0) {
        fprintf(out, " and %ld frequenc%s", report->frequencies,
                report->frequencies == 1 ? "y" : "ies");
    }
    fprintf(out, ": worst defect %.2g", report->audit.worst);
    if (report->audit.worst > 0.0) {
        fprintf(out, " of %s", report->audit.where);
    }
    if (report->audit.worst > 0.0 &&
        report->audit.time > 0.0) { /* points and frequencies have none */
        fprintf(out, " at %s", dalcs_quantity_write(text, report->audit.time, "s", DIGITS));
    }
    const bool is_wrong = report->audit.worst > report->audit.allowed;
    if (report->audit.positions > 0 && !is_wrong) {
        fprintf(out, "; %ld switch position%s right", report->audit.positions,
                plural(report->audit.positions));
    }
    if (report->unjudged > 0 && !is_wrong) {
        fprintf(out, "; %ld where it is coarse not judged", report->unjudged);
    }
    if (is_wrong) {
        fprintf(out, ", more than %.2g", report->audit.allowed);
    }
    fputc('\n', out);
}

static void write_certificate(FILE *out, const struct dalcs_report *report) {
    char text[DALCS_QUANTITY_SIZE];
    if (report->audit.mode != NULL && (report->audit.segments > 0 || report->work.steps == 0)) {
        write_audit(out, report);
        return;
    }
    fprintf(out, "  proof     worst residual %.2g", report->certificate.worst);
    if (report->certificate.where && report->certificate.where[0]) {
        fprintf(out, " at %s (%s)",
                dalcs_quantity_write(text, report->certificate.time, "s", DIGITS),
                report->certificate.where);
    }
    fputc('\n', out);
}

static void write_nonunique(FILE *out, const struct dalcs_report *report) {
    if (report->n_nonunique > 0) {
        fprintf(out, "  open      %zu signal%s not determined by the circuit: see the messages\n",
                report->n_nonunique, report->n_nonunique == 1 ? " is" : "s are");
    }
}

void dalcs_summary_write_run(FILE *out, const struct dalcs_report *report) {
    const char *title = report->title ? report->title : "";
    title += strspn(title, "* "); /* many a netlist's title is written as a comment */
    fprintf(out, "%s\n", title);
    write_size(out, report);
    write_method(out, report);
    write_work(out, report);
    write_certificate(out, report);
    write_nonunique(out, report);
}

static void write_energy(FILE *out, const char *name, double joule, double largest) {
    char text[DALCS_QUANTITY_SIZE];
    if (fabs(joule) > DALCS_SUMMARY_INVISIBLE * largest) {
        fprintf(out, "  %-18s %11s\n", name, dalcs_quantity_write_column(text, joule, "J", DIGITS));
    }
}

void dalcs_summary_write_energy(FILE *out, const struct dalcs_report *report) {
    if (!report->energy.present) {
        return;
    }

    const struct {
        const char *name;
        double joule;
    } entry[] = {{"from sources", report->energy.sources},
                 {"in resistors", report->energy.resistors},
                 {"in diodes", report->energy.diodes},
                 {"lost in jumps", report->energy.jumps},
                 {"change stored", report->energy.stored_change},
                 {"lost by the method", report->energy.method},
                 {"unexplained", report->energy.balance}};

    const size_t n = sizeof entry / sizeof entry[0];
    double largest = 0.0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(entry[i].joule));
    }
    fprintf(out, "\n  energy%s\n", largest > 0.0 ? "" : "              0  J");
    for (size_t i = 0; i < n; i++) {
        write_energy(out, entry[i].name, entry[i].joule, largest);
    }
}

static void write_jump(FILE *out, const struct dalcs_jump *jump) {
    char a[DALCS_QUANTITY_SIZE], b[DALCS_QUANTITY_SIZE];
    fprintf(out, "  jump at t=%s:",
            jump->time == 0.0 ? "0" : dalcs_quantity_write(a, jump->time, "s", 6));
    for (size_t i = 0; i < jump->n_states && i < MAX_PARTS; i++) {
        const struct dalcs_jump_state *state = &jump->state[i];
        const char *unit = state->element[0] == 'l' ? "A" : "V";
        fprintf(out, "%s %s %s -> %s", i > 0 ? "," : "", state->element,
                dalcs_quantity_write(a, state->before, unit, DIGITS),
                dalcs_quantity_write(b, state->after, unit, DIGITS));
    }
    if (jump->n_states > MAX_PARTS) {
        fprintf(out, ", %zu more", jump->n_states - MAX_PARTS);
    }
    for (size_t i = 0; i < jump->n_impulses && i < MAX_PARTS; i++) {
        const struct dalcs_impulse *impulse = &jump->impulse[i];
        fprintf(out, "%s %s %s", i > 0 ? "," : ";",
                impulse->is_flux ? "flux across" : "charge through", impulse->element);
        fprintf(out, " %s",
                dalcs_quantity_write(a, impulse->value, impulse->is_flux ? "Wb" : "C", DIGITS));
    }
    fprintf(out, "; %s lost\n", dalcs_quantity_write(a, jump->energy_lost, "J", DIGITS));
}

void dalcs_summary_write_jumps(FILE *out, const struct dalcs_report *report) {
    size_t n = report->n_jumps < MAX_JUMPS ? report->n_jumps : MAX_JUMPS;
    if (n > 0) {
        fputc('\n', out);
    }
    for (size_t i = 0; i < n; i++) {
        write_jump(out, &report->jump[i]);
    }
    size_t more = report->n_jumps + report->n_jumps_dropped - n;
    if (more > 0) {
        fprintf(out, "  ... and %zu more jump%s: --report\n", more, plural((long)more));
    }
}
