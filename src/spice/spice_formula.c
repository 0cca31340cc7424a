/* spice_formula.c - sources with a formula as B sources of ngspice.
 *
 * What pairs.c made of a formula is turned back: a kink is a max, a saturation a min of a max. A lambda
 * that others ask for is the voltage of a node, held by a B source of its own, so that nothing is
 * written twice; a function of time is a source with its edges. A jump is what an ngspice user would
 * write, u(x), where devices are stock ones. ngspice holds no value between the two sides of it, so
 * that elsewhere it is a slope, as steep as a closed switch's resistance is small. */
#include "spice.h"

#include <math.h>

struct formula {
    const struct dalcs_spice_names *names;
    const struct dalcs_spice_options *options;
    FILE *stream;
    int device;
    const struct dalcs_behaviour *behaviour;
};

/* Is pair k the second of a saturation or a jump? */
static bool is_second(const struct formula *f, int k) {
    return k > 0 && dalcs_affine_of_pair(&f->behaviour->w[k - 1], k) != 0.0;
}

static bool has_second(const struct formula *f, int k) {
    return k + 1 < f->behaviour->n_pairs && is_second(f, k + 1);
}

/* Do other pairs than its own two read lambda k? */
static bool has_node(const struct formula *f, int k) {
    const int first = is_second(f, k) ? k - 1 : k;
    bool asked = false;
    for (int j = 0; j < f->behaviour->n_pairs; j++) {
        asked = asked || (j != first && !(j == first + 1 && is_second(f, j)) &&
                          dalcs_affine_of_pair(&f->behaviour->w[j], k) != 0.0);
    }
    return asked;
}

static void write_lambda(const struct formula *f, int k);

static void write_term(const struct formula *f, const struct dalcs_affine_term *term) {
    const struct dalcs_spice_names *names = f->names;
    switch (term->kind) {
    case DALCS_QUANTITY_VOLTAGE:
        fprintf(f->stream, "v(%s)", names->node[names->node_of[term->index]]);
        break;
    case DALCS_QUANTITY_CURRENT:
        if (names->is_sensed[term->index]) {
            fprintf(f->stream, "i(v__%d)", term->index);
        } else {
            fprintf(f->stream, "i(%s)", names->device[term->index]);
        }
        break;
    case DALCS_QUANTITY_STIMULUS:
        fprintf(f->stream, "v(q__%d)", term->index);
        break;
    case DALCS_QUANTITY_PAIR:
        if (has_node(f, term->index)) {
            fprintf(f->stream, "v(l__%d_%d)", f->device, term->index);
        } else {
            write_lambda(f, term->index);
        }
        break;
    case DALCS_QUANTITY_TIME:
    case DALCS_QUANTITY_WAVE:
        break; /* while formulas are compiled only */
    }
}

/* factor a, without the lambdas of pairs `first` and `last`. */
static void write_affine(const struct formula *f, const struct dalcs_affine *a, double factor,
                         int first, int last) {
    dalcs_spice_write_number(f->stream, factor * a->constant);
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        bool is_ground =
            term->kind == DALCS_QUANTITY_VOLTAGE && f->names->node_of[term->index] == 0;
        bool is_own =
            term->kind == DALCS_QUANTITY_PAIR && (term->index == first || term->index == last);
        if (!is_ground && !is_own) {
            fputs("\n+ +(", f->stream);
            dalcs_spice_write_number(f->stream, factor * term->coefficient);
            fputs(")*", f->stream);
            write_term(f, term);
        }
    }
}

/* 0 <= lambda _|_ resistance lambda - argument >= 0 */
static void write_kink(const struct formula *f, int k) {
    const struct dalcs_affine *w = &f->behaviour->w[k];
    fputs("max(", f->stream);
    write_affine(f, w, -1.0 / dalcs_affine_of_pair(w, k), k, k);
    fputs(", 0)", f->stream);
}

/* 0 <= lambda _|_ nu + resistance lambda - argument >= 0, 0 <= nu _|_ height - lambda >= 0 */
static void write_saturation(const struct formula *f, int k) {
    const struct dalcs_affine *w = &f->behaviour->w[k];
    const double height = f->behaviour->w[k + 1].constant, resistance = dalcs_affine_of_pair(w, k);
    if (resistance == 0.0 && f->options->diode == DALCS_SPICE_STOCK) {
        dalcs_spice_write_number(f->stream, height);
        fputs("*u(", f->stream);
        write_affine(f, w, -1.0, k, k + 1);
        fputs(")", f->stream);
        return;
    }
    const double middle = resistance == 0.0 ? 0.5 * height : 0.0;
    fputs("min(max(", f->stream);
    dalcs_spice_write_number(f->stream, middle);
    fputs("+", f->stream);
    write_affine(f, w, -1.0 / (resistance == 0.0 ? f->options->on : resistance), k, k + 1);
    fputs(", 0), ", f->stream);
    dalcs_spice_write_number(f->stream, height);
    fputs(")", f->stream);
}

/* The nu of the saturation of pair k: max(argument - resistance height, 0) */
static void write_beyond(const struct formula *f, int k) {
    const struct dalcs_affine *w = &f->behaviour->w[k];
    fputs("max(", f->stream);
    write_affine(f, w, -1.0, k, k + 1);
    fputs("-", f->stream);
    dalcs_spice_write_number(f->stream,
                             dalcs_affine_of_pair(w, k) * f->behaviour->w[k + 1].constant);
    fputs(", 0)", f->stream);
}

static void write_lambda(const struct formula *f, int k) {
    if (is_second(f, k)) {
        write_beyond(f, k - 1);
    } else if (has_second(f, k)) {
        write_saturation(f, k);
    } else {
        write_kink(f, k);
    }
}

static void write_argument(const struct formula *f, const struct dalcs_smooth *smooth, int k) {
    if (smooth->node[k] >= 0) {
        fprintf(f->stream, "v(%s)", f->names->node[f->names->node_of[smooth->node[k]]]);
    } else {
        dalcs_spice_write_number(f->stream, smooth->number[k]);
    }
}

/* Functions that ngspice has no name for: text around the argument. */
struct of_exponentials {
    enum dalcs_smooth_kind kind;
    int n_arguments;
    const char *text[3];
};

static const struct of_exponentials *find_written(enum dalcs_smooth_kind kind) {
    static const struct of_exponentials written[] = {
        {DALCS_SMOOTH_LOGISTIC, 1, {"(0.5+0.5*tanh(0.5*", "))", NULL}},
        {DALCS_SMOOTH_SOFTPLUS, 2, {"(max(", ",0)+ln(1+exp(-abs(", "))))"}},
        {DALCS_SMOOTH_BERNOULLI, 2, {"(", "/(exp(", ")-1))"}},
    };
    const struct of_exponentials *found = NULL;
    for (size_t k = 0; k < sizeof written / sizeof *written; k++) {
        found = written[k].kind == kind ? &written[k] : found;
    }
    return found;
}

/* (a)*(b), pwr(a,b), exp(a). In ngspice pow takes the magnitude of its base, and pwr gives it the base's sign again. */
static void write_smooth(const struct formula *f, const struct dalcs_smooth *smooth) {
    const struct of_exponentials *written = find_written(smooth->kind);
    if (written != NULL) {
        for (int k = 0; k < written->n_arguments; k++) {
            fputs(written->text[k], f->stream);
            write_argument(f, smooth, 0);
        }
        fputs(written->text[written->n_arguments], f->stream);
        return;
    }
    const bool is_odd = smooth->kind == DALCS_SMOOTH_POWER && smooth->node[1] < 0 &&
                        fabs(fmod(smooth->number[1], 2.0)) == 1.0;
    const bool has_sign = is_odd || smooth->kind == DALCS_SMOOTH_SIGNED_POWER;
    const char *name =
        has_sign                                                                             ? "pwr"
        : smooth->kind == DALCS_SMOOTH_POWER || smooth->kind == DALCS_SMOOTH_MAGNITUDE_POWER ? "pow"
        : smooth->kind == DALCS_SMOOTH_SQUARE                                                ? "sqr"
                                              : dalcs_smooth_name(smooth->kind);
    const bool is_infix = *name == '*' || *name == '/';
    fputs(is_infix ? "" : name, f->stream);
    fputs("(", f->stream);
    write_argument(f, smooth, 0);
    if (smooth->n > 1) {
        fprintf(f->stream, is_infix ? ")%s(" : ",", name);
        write_argument(f, smooth, 1);
    }
    fputs(")", f->stream);
}

void dalcs_spice_write_formula(const struct dalcs_spice_names *names,
                               const struct dalcs_spice_options *options, FILE *stream, int i,
                               const char *first_node) {
    const struct dalcs_device *device = &names->circuit->device[i];
    const struct formula f = {names, options, stream, i, dalcs_device_written(device)};
    fprintf(stream, "%s %s %s %c=", names->device[i], first_node,
            names->node[names->node_of[device->node[1]]], device->kind == DALCS_VCVS ? 'v' : 'i');
    if (f.behaviour->smooth != NULL) {
        write_smooth(&f, f.behaviour->smooth);
    } else {
        write_affine(&f, &f.behaviour->output, 1.0, -1, -1);
    }
    fputc('\n', stream);
    for (int k = 0; k < f.behaviour->n_pairs; k++) {
        if (has_node(&f, k)) {
            fprintf(stream, "bl__%d_%d l__%d_%d 0 v=", i, k, i, k);
            write_lambda(&f, k);
            fputc('\n', stream);
        }
    }
}

struct search {
    int stimulus;
    bool found;
};

static void look_at(void *to, const struct dalcs_affine_term *term) {
    struct search *search = to;
    search->found =
        search->found || (term->kind == DALCS_QUANTITY_STIMULUS && term->index == search->stimulus);
}

bool dalcs_spice_takes_stimulus(const struct dalcs_circuit *circuit, int i, int k) {
    struct search search = {.stimulus = k};
    dalcs_behaviour_visit(dalcs_device_written(&circuit->device[i]), look_at, &search);
    return search.found;
}

const char *dalcs_spice_write_stimulus(const struct dalcs_circuit *circuit, FILE *stream, int k,
                                       double edge) {
    const struct dalcs_stimulus *stimulus = &circuit->stimulus[k];
    const char *trouble = NULL;
    if (dalcs_spice_needs_expression(stimulus)) {
        fprintf(stream, "bq__%d q__%d 0 v=", k, k);
        dalcs_spice_write_expression(stream, stimulus);
    } else {
        fprintf(stream, "vq__%d q__%d 0 ", k, k);
        trouble =
            dalcs_spice_write_source(stream, stimulus, edge, circuit->analyses.transient.stop);
    }
    fputc('\n', stream);
    return trouble;
}
