/* write_system.c - a network for machines: the cards of a system file, or the same as JSON, or with the
 * matrices as Matrix Market files beside it. What is read back is what was written, to the bit. */
#include "equations.h"

#include "impulse_network.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct writer {
    enum dalcs_machine_format format;
    const struct dalcs_equations_files *files;
    FILE *out;
    bool first; /* JSON: nothing yet in the present list */
    bool in_card;
    int n_matrices;
    enum dalcs_status status;
};

void dalcs_write_number(FILE *f, double value) {
    char text[40];
    for (int digits = 15; digits <= 17; digits++) { /* the fewest that give the same number back */
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    size_t point = strspn(text, "+-0123456789");
    size_t rest = point + strcspn(text + point, "+-0123456789e");
    if (isfinite(value) && rest > point) { /* whatever the locale's point is */
        text[point] = '.';
        memmove(text + point + 1, text + rest, strlen(text + rest) + 1);
    }
    fputs(text, f);
}

static bool is_plain(const char *name) {
    return name[0] != '\0' && strpbrk(name, " \t,=();$'{}") == NULL && name[0] != '"';
}

void dalcs_write_name(FILE *f, const char *name) {
    fprintf(f, is_plain(name) ? "%s" : "\"%s\"", name);
}

/* ---- Cards --------------------------------------------------------------------------------- */

static void put_raw(struct writer *w, const char *text) {
    for (const char *p = text; *p != '\0' && w->format == DALCS_AS_JSON; p++) {
        if (*p == '"' || *p == '\\') {
            fputc('\\', w->out);
        }
        fputc(*p == '\t' ? ' ' : *p, w->out);
    }
    if (w->format != DALCS_AS_JSON) {
        fputs(text, w->out);
    }
}

static void begin_card(struct writer *w, const char *word) {
    if (w->format == DALCS_AS_JSON) {
        fputs(w->first ? "\n[\"" : ",\n[\"", w->out);
        w->first = false;
    }
    put_raw(w, word);
}

static void between(struct writer *w) {
    fputs(w->format == DALCS_AS_JSON ? "\", \"" : " ", w->out);
}

static void put_word(struct writer *w, const char *word) {
    between(w);
    put_raw(w, word);
}

static void put_name(struct writer *w, const char *name) {
    bool quoted = !is_plain(name);
    between(w);
    put_raw(w, quoted ? "\"" : "");
    put_raw(w, name);
    put_raw(w, quoted ? "\"" : "");
}

static void put_number(struct writer *w, double value) {
    between(w);
    dalcs_write_number(w->out, value);
}

static void put_parameter(struct writer *w, const char *name, double value) {
    put_word(w, name);
    fputc('=', w->out);
    dalcs_write_number(w->out, value);
}

static void put_unit(struct writer *w, bool is_current) {
    put_word(w, is_current ? "A" : "V");
}

static void end_card(struct writer *w) {
    fputs(w->format == DALCS_AS_JSON ? "\"]" : "\n", w->out);
}

/* ---- Source functions ----------------------------------------------------------------------- */

/* name(a b c ...), without what at the end is infinite, or 0 after the first `least`: left out it is so,
 * too. */
static void write_function(FILE *f, const char *name, const double *value, int n, int least) {
    while (n > 0 && (!isfinite(value[n - 1]) || (n > least && value[n - 1] == 0.0))) {
        n--;
    }
    fprintf(f, "%s(", name);
    for (int k = 0; k < n; k++) {
        fputs(k > 0 ? " " : "", f);
        dalcs_write_number(f, isfinite(value[k]) ? value[k] : DBL_MAX);
    }
    fputc(')', f);
}

static void write_points(FILE *f, const struct dalcs_stimulus *s) {
    int n = s->u.pwl.n;
    fputs("PWL(", f);
    for (int k = 0; k < n; k++) {
        fputs(k > 0 ? " " : "", f);
        dalcs_write_number(f, s->u.pwl.t[k]);
        fputc(' ', f);
        dalcs_write_number(f, s->u.pwl.v[k]);
    }
    fputc(')', f);
    if (s->u.pwl.repeats) {
        int nearest = 0; /* what is repeated starts at a point, up to rounding */
        for (int k = 1; k < n; k++) {
            double distance = fabs(s->u.pwl.t[k] - s->u.pwl.repeat_from);
            nearest = distance < fabs(s->u.pwl.t[nearest] - s->u.pwl.repeat_from) ? k : nearest;
        }
        fputs(" r=", f);
        dalcs_write_number(f, s->u.pwl.t[nearest]);
    }
}

static void write_tones(FILE *f, const struct dalcs_stimulus *s) {
    fputs("TONES(", f);
    dalcs_write_number(f, s->u.tones.offset);
    fputc(' ', f);
    dalcs_write_number(f, s->u.tones.delay);
    for (int k = 0; k < s->u.tones.n; k++) {
        const struct dalcs_tone *t = &s->u.tones.tone[k];
        const double value[] = {t->amplitude, t->frequency, t->phase};
        for (int i = 0; i < 3; i++) {
            fputc(' ', f);
            dalcs_write_number(f, value[i]);
        }
    }
    fputc(')', f);
}

static void write_numbers(FILE *f, const double *value, int n) {
    for (int k = 0; k < n; k++) {
        dalcs_write_number(f, value[k]);
        fputc(' ', f);
    }
}

/* FORMULA(before after knots, at left value right of each, constant, factor (stimulus) ...) */
static void write_formula(FILE *f, const struct dalcs_stimulus *s) {
    const struct dalcs_piecewise *of = &s->u.formula.function;
    const struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    fputs("FORMULA(", f);
    write_numbers(f, (const double[]){of->before, of->after, of->n}, 3);
    for (int k = 0; k < of->n; k++) {
        const struct dalcs_knot *knot = &of->knot[k];
        write_numbers(f, (const double[]){knot->at, knot->left, knot->value, knot->right}, 4);
    }
    dalcs_write_number(f, sum->constant);
    for (int k = 0; k < sum->n; k++) {
        fputc(' ', f);
        dalcs_write_number(f, sum->part[k].factor);
        fputs(" (", f);
        dalcs_write_stimulus(f, sum->part[k].of);
        fputc(')', f);
    }
    fputc(')', f);
}

void dalcs_write_stimulus(FILE *f, const struct dalcs_stimulus *s) {
    if (s->has_dc || s->kind == DALCS_STIMULUS_DC) {
        fputs("dc ", f);
        dalcs_write_number(f, s->dc);
        fputs(s->kind == DALCS_STIMULUS_DC ? "" : " ", f);
    }
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        break;
    case DALCS_STIMULUS_SIN:
        write_function(f, "SIN",
                       (const double[]){s->u.sine.offset, s->u.sine.amplitude, s->u.sine.frequency,
                                        s->u.sine.delay, s->u.sine.damping, s->u.sine.phase,
                                        s->u.sine.n_cycles},
                       7, 3);
        break;
    case DALCS_STIMULUS_PULSE: {
        bool ends = isfinite(s->u.pulse.period); /* only then does a count mean anything */
        write_function(f, "PULSE",
                       (const double[]){s->u.pulse.low, s->u.pulse.high, s->u.pulse.delay,
                                        s->u.pulse.rise, s->u.pulse.fall, s->u.pulse.width,
                                        s->u.pulse.period, s->u.pulse.n_periods},
                       ends ? 8 : 7, 7);
        break;
    }
    case DALCS_STIMULUS_EXP: {
        bool falls = isfinite(s->u.exponential.fall_delay);
        write_function(f, "EXP",
                       (const double[]){s->u.exponential.low, s->u.exponential.high,
                                        s->u.exponential.rise_delay, s->u.exponential.rise_tau,
                                        s->u.exponential.fall_delay, s->u.exponential.fall_tau},
                       falls ? 6 : 4, 6);
        break;
    }
    case DALCS_STIMULUS_PWL:
        write_points(f, s);
        break;
    case DALCS_STIMULUS_TONES:
        write_tones(f, s);
        break;
    case DALCS_STIMULUS_FORMULA:
        write_formula(f, s);
        break;
    }
}

static void put_stimulus(struct writer *w, const struct dalcs_stimulus *s) {
    between(w);
    dalcs_write_stimulus(w->out, s);
}

/* ---- Matrices ------------------------------------------------------------------------------ */

/* Rows first_row.. and columns first_column.. of a matrix. */
struct view {
    const struct dalcs_csr *a;
    int first_row, n_rows, first_column, n_columns;
};

static int count_entries(const struct view *v) {
    int n = 0;
    for (int i = v->first_row; i < v->first_row + v->n_rows; i++) {
        for (int k = v->a->p[i]; k < v->a->p[i + 1]; k++) {
            n += v->a->j[k] >= v->first_column && v->a->j[k] < v->first_column + v->n_columns;
        }
    }
    return n;
}

static void list_entries(FILE *f, const struct view *v, const char *before, const char *after) {
    for (int i = v->first_row; i < v->first_row + v->n_rows; i++) {
        for (int k = v->a->p[i]; k < v->a->p[i + 1]; k++) {
            int j = v->a->j[k] - v->first_column;
            if (j >= 0 && j < v->n_columns) {
                fprintf(f, "%s%d %d ", before, i - v->first_row + 1, j + 1);
                dalcs_write_number(f, v->a->x[k]);
                fputs(after, f);
            }
        }
    }
}

static void list_json(FILE *f, const struct view *v) {
    static const char *const key[] = {"row", "column", "value"};
    fprintf(f, "{\"rows\": %d, \"columns\": %d", v->n_rows, v->n_columns);
    for (int part = 0; part < 3; part++) {
        bool first = true;
        fprintf(f, ", \"%s\": [", key[part]);
        for (int i = v->first_row; i < v->first_row + v->n_rows; i++) {
            for (int k = v->a->p[i]; k < v->a->p[i + 1]; k++) {
                int j = v->a->j[k] - v->first_column;
                if (j < 0 || j >= v->n_columns) {
                    continue;
                }
                fputs(first ? "" : ", ", f);
                first = false;
                if (part < 2) {
                    fprintf(f, "%d", part == 0 ? i - v->first_row + 1 : j + 1);
                } else {
                    dalcs_write_number(f, v->a->x[k]);
                }
            }
        }
        fputc(']', f);
    }
    fputc('}', f);
}

/* A file of its own. */
static void put_market(struct writer *w, const char *name, const struct view *v, int n) {
    char suffix[64];
    char *text = NULL;
    size_t length;
    if (w->n_matrices++ == 0) { /* no two of a set have the same name */
        snprintf(suffix, sizeof suffix, ".%s.mtx", name);
    } else {
        snprintf(suffix, sizeof suffix, ".%d.%s.mtx", w->n_matrices, name);
    }
    FILE *f = open_memstream(&text, &length);
    if (f == NULL) {
        w->status = DALCS_E_NOMEM;
        return;
    }
    fprintf(f, "%%%%MatrixMarket matrix coordinate real general\n%d %d %d\n", v->n_rows,
            v->n_columns, n);
    list_entries(f, v, "", "\n");
    bool lost = ferror(f) != 0;
    lost = fclose(f) != 0 || lost || text == NULL;
    if (lost) {
        w->status = DALCS_E_NOMEM;
    } else if (w->status == DALCS_OK) {
        w->status = w->files->file(w->files->user, suffix, text, length);
    }
    free(text);
    fprintf(w->out, "matrix %s \"%s%s\"\n", name, w->files->stem, suffix);
}

static void put_matrix(struct writer *w, const char *name, const struct view *v) {
    int n = v->n_rows > 0 && v->n_columns > 0 ? count_entries(v) : 0;
    bool is_default = n == 0; /* what is not written is 0 */
    if (is_default) {
        return;
    }
    if (w->format == DALCS_AS_MATRIX_MARKET) {
        put_market(w, name, v, n);
    } else if (w->format == DALCS_AS_JSON) {
        fprintf(w->out, "%s\n\"%s\": ", w->first ? "" : ",", name);
        w->first = false;
        list_json(w->out, v);
    } else {
        fprintf(w->out, "matrix %s sparse\n", name);
        list_entries(w->out, v, "+ ", "\n");
    }
}

static void put_matrices(struct writer *w, const struct dalcs_system *s) {
    const int x = s->n_x;
    const int z = s->n_z;
    const int m = s->n_pairs;
    const int u = s->n_inputs - 1;

    const struct {
        const char *name;
        struct view view;
    } block[] = {
        {"P", {&s->P, 0, x, 0, x}},
        {"A_I", {&s->A, 0, x, 0, x}},
        {"B_I", {&s->A, 0, x, x, z}},
        {"Bbar_I", {&s->A, 0, x, x + z, m}},
        {"E_I", {&s->E, 0, x, 1, u}},
        {"constant_I", {&s->E, 0, x, 0, 1}},
        {"A_II", {&s->A, x, z, 0, x}},
        {"B_II", {&s->A, x, z, x, z}},
        {"Bbar_II", {&s->A, x, z, x + z, m}},
        {"E_II", {&s->E, x, z, 1, u}},
        {"constant_II", {&s->E, x, z, 0, 1}},
        {"C_I", {&s->C, 0, m, 0, x}},
        {"C_II", {&s->C, 0, m, x, z}},
        {"D", {&s->C, 0, m, x + z, m}},
        {"F", {&s->F, 0, m, 1, u}},
        {"constant_F", {&s->F, 0, m, 0, 1}},
        {"storage", {&s->storage, 0, x, 0, x}},
        {"control", {&s->control, 0, m, 0, x + z + m}},
        {"direct_control", {&s->direct_control, 0, m, 1, u}},
    };

    for (size_t k = 0; k < sizeof block / sizeof *block; k++) {
        put_matrix(w, block[k].name, &block[k].view);
    }
}

/* ---- Systems ------------------------------------------------------------------------------- */

static const char *const kind_name[] = {[DALCS_LABEL_STATE] = "kind=state",
                                        [DALCS_LABEL_NODE] = "kind=node",
                                        [DALCS_LABEL_BRANCH] = "kind=branch",
                                        [DALCS_LABEL_REFERENCE] = "kind=reference"};

static void put_columns(struct writer *w, const struct dalcs_system *s, const double *initial) {
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        bool is_state = c < s->n_x;
        begin_card(w, is_state ? "state" : "unknown");
        put_name(w, s->column[c].element);
        put_unit(w, s->column_is_current[c]);
        if (is_state && initial != NULL) {
            put_number(w, initial[c]);
        }
        if (s->column[c].kind != (is_state ? DALCS_LABEL_STATE : DALCS_LABEL_BRANCH)) {
            put_word(w, kind_name[s->column[c].kind]);
        }
        if (s->forest_root[c] != c) {
            put_parameter(w, "root", s->forest_root[c] + 1);
        }
        end_card(w);
    }
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        begin_card(w, "row");
        put_name(w, s->row[r].element);
        put_unit(w, s->row_is_current[r]);
        if (s->row[r].kind != DALCS_LABEL_BRANCH) {
            put_word(w, kind_name[s->row[r].kind]);
        }
        put_parameter(w, "dual", s->dual[r] + 1);
        end_card(w);
    }
}

static void put_pairs(struct writer *w, const struct dalcs_system *s) {
    for (int d = 0; d < s->n_pairs; d++) {
        const struct dalcs_pair *p = &s->pair[d];
        bool is_switch = p->kind == DALCS_PAIR_SWITCH;
        begin_card(w, is_switch         ? "switch"
                      : p->is_breakdown ? "reverse"
                      : p->is_formula   ? "corner"
                                        : "pair");
        put_name(w, p->element);
        if (is_switch) {
            put_parameter(w, "on", p->turn_on);
            put_parameter(w, "off", p->turn_off);
        }
        if (p->initially_on) {
            put_word(w, "closed");
        }
        if (p->is_direct) {
            put_word(w, "direct");
        }
        end_card(w);
    }
}

static void put_system(struct writer *w, const struct dalcs_system *s, const double *initial,
                       bool jumps_are_covered) {
    if (w->format == DALCS_AS_JSON) {
        fputs(w->first ? "\n{\"cards\": [" : ",\n{\"cards\": [", w->out);
        w->first = true;
    } else {
        fputs("system\n", w->out);
    }
    begin_card(w, "monotone");
    put_word(w, s->monotone ? "yes" : "no");
    end_card(w);
    if (jumps_are_covered) {
        begin_card(w, "jumps_are_covered");
        end_card(w);
    }
    begin_card(w, "inputs");
    for (int k = 1; k < s->n_inputs; k++) {
        put_name(w, s->input_element[k]);
    }
    end_card(w);
    put_columns(w, s, initial);
    put_pairs(w, s);
    if (w->format == DALCS_AS_JSON) {
        fputs("],\n\"matrices\": {", w->out);
        w->first = true;
    }
    put_matrices(w, s);
    if (w->format == DALCS_AS_JSON) {
        fputs("}}", w->out);
        w->first = false;
    }
}

/* ---- Outputs ------------------------------------------------------------------------------- */

static void put_probe(struct writer *w, const struct dalcs_probe *p) {
    put_word(w, "in");
    put_number(w, p->system + 1);
    for (int k = 0; k < p->n_terms + p->n_inputs; k++) {
        char reference[24];
        bool is_input = k >= p->n_terms;
        snprintf(reference, sizeof reference, "%c%d", is_input ? '@' : '#',
                 p->term[k].index + (is_input ? 0 : 1));
        put_word(w, reference);
        put_number(w, p->term[k].coefficient);
    }
}

static void put_outputs(struct writer *w, const struct dalcs_network *n) {
    for (int i = 0; i < n->n_outputs; i++) {
        const struct dalcs_output *out = &n->output[i];
        begin_card(w, "output");
        put_name(w, out->name);
        put_unit(w, out->is_current);
        if (out->plus.system >= 0) {
            put_probe(w, &out->plus);
        }
        if (out->minus.system >= 0) {
            put_word(w, "minus");
            put_probe(w, &out->minus);
        }
        end_card(w);
    }
    for (int i = 0; i < n->n_states; i++) {
        const struct dalcs_state *state = &n->state[i];
        begin_card(w, "element");
        put_name(w, state->element);
        put_unit(w, state->is_current);
        if (state->probe.system >= 0) {
            put_probe(w, &state->probe);
        }
        end_card(w);
    }
}

static void put_network(struct writer *w, const char *name, const struct dalcs_network *n,
                        bool with_initial, const bool *covered) {
    if (w->format == DALCS_AS_JSON) {
        fprintf(w->out, "%s\n{\"name\": \"%s\", \"systems\": [", w->first ? "" : ",", name);
    } else {
        fprintf(w->out, "network %s\n", name);
    }
    w->first = true;
    for (int k = 0; k < n->n_systems; k++) {
        put_system(w, &n->system[k], with_initial ? n->initial[k] : NULL,
                   covered != NULL && covered[k]);
    }
    if (w->format == DALCS_AS_JSON) {
        fputs("],\n\"cards\": [", w->out);
        w->first = true;
    }
    put_outputs(w, n);
    if (w->format == DALCS_AS_JSON) {
        fputs("]}", w->out);
        w->first = false;
    }
}

/* ---- What is asked for ---------------------------------------------------------------------- */

static void put_analyses(struct writer *w, const struct dalcs_circuit *c) {
    const struct dalcs_transient *t = &c->transient;
    if (c->operating_point) {
        begin_card(w, ".op");
        end_card(w);
    }
    if (t->present) {
        begin_card(w, ".tran");
        put_number(w, t->step);
        put_number(w, t->stop);
        if (t->start > 0.0 || t->max_step > 0.0) {
            put_number(w, t->start);
        }
        if (t->max_step > 0.0) {
            put_number(w, t->max_step);
        }
        if (t->use_initial_conditions) {
            put_word(w, "uic");
        }
        end_card(w);
    }
}

static void put_option(struct writer *w, const char *name, double value) {
    if (value != 0.0) {
        begin_card(w, ".options");
        put_parameter(w, name, value);
        end_card(w);
    }
}

static void put_options(struct writer *w, const struct dalcs_circuit_options *o) {
    put_option(w, "reltol", o->reltol);
    put_option(w, "abstol", o->abstol);
    put_option(w, "vntol", o->vntol);
    put_option(w, "step", o->step);
    put_option(w, "stages", o->stages);
    put_option(w, "compress", o->compress);
    if (o->method != NULL) {
        begin_card(w, ".options");
        put_word(w, "method=");
        put_raw(w, o->method);
        end_card(w);
    }
}

static void put_inputs(struct writer *w, const struct dalcs_equations *e) {
    const struct dalcs_network *n = e->network;
    for (int i = 0; i < e->circuit->n_stimuli; i++) {
        const char *name = NULL;
        for (int k = 0; k < n->n_systems && name == NULL; k++) {
            for (int u = 1; u < n->system[k].n_inputs && name == NULL; u++) {
                name = n->system[k].stimulus[u] == i ? n->system[k].input_element[u] : NULL;
            }
        }
        for (int d = 0; d < e->circuit->n_devices && name == NULL; d++) {
            name = e->circuit->device[d].stimulus == i ? e->circuit->device[d].name : NULL;
        }
        if (name == NULL) {
            continue;
        }
        begin_card(w, "input");
        put_name(w, name);
        put_stimulus(w, &e->circuit->stimulus[i]);
        end_card(w);
    }
}

static void put_head(struct writer *w, const struct dalcs_equations *e) {
    if (w->format == DALCS_AS_JSON) {
        fputs("{\"dalcs-system\": 2,\n\"title\": \"", w->out);
        put_raw(w, e->circuit->title);
        fputs("\",\n\"cards\": [", w->out);
        w->first = true;
    } else {
        fprintf(w->out, "dalcs-system 2 %s\n", e->circuit->title);
    }
    put_analyses(w, e->circuit);
    put_options(w, &e->circuit->options);
    put_inputs(w, e);
    if (w->format == DALCS_AS_JSON) {
        fputs("],\n\"networks\": [", w->out);
        w->first = true;
    }
}

static void put_all(struct writer *w, const struct dalcs_equations *e) {
    const struct dalcs_network *n = e->network;
    put_head(w, e);
    put_network(w, "main", n, e->circuit->transient.use_initial_conditions, e->jumps_are_covered);
    static const char *const name[] = {
        [DALCS_IMPULSE_CHARGE] = "charge", [DALCS_IMPULSE_FLUX] = "flux"};
    for (int kind = 0; kind < DALCS_N_IMPULSES; kind++) {
        if (e->jump[kind] != NULL) {
            put_network(w, name[kind], e->jump[kind], false, NULL);
        }
    }
    if (e->held != NULL) {
        put_network(w, "held", e->held, false, NULL);
    }
    fputs(w->format == DALCS_AS_JSON ? "]}\n" : ".end\n", w->out);
}

enum dalcs_status dalcs_equations_write_system(const struct dalcs_equations *equations,
                                               enum dalcs_machine_format format,
                                               const struct dalcs_equations_files *files) {
    char *text = NULL;
    size_t length;
    struct writer w = {.format = format, .files = files};
    w.out = open_memstream(&text, &length);
    if (w.out == NULL) {
        return DALCS_E_NOMEM;
    }
    put_all(&w, equations);
    bool lost = ferror(w.out) != 0;
    lost = fclose(w.out) != 0 || lost || text == NULL;
    w.status = w.status == DALCS_OK && lost ? DALCS_E_NOMEM : w.status;
    if (w.status == DALCS_OK) {
        w.status = files->file(files->user, "", text, length);
    }
    free(text);
    return w.status;
}
