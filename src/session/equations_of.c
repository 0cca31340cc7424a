/* equations_of.c - the session's equations, in any form and format. */
#include "session_internal.h"

#include "equations.h"
#include "jumps.h"

#include <math.h>
#include <stdlib.h>

/* All that is written of a circuit: its network, and those that a run would build later. */
struct whole {
    struct dalcs_equations equations;
    struct dalcs_jumps jumps;
    struct dalcs_network held, reduced;
};

static void whole_finish(struct whole *w) {
    dalcs_jumps_finish(&w->jumps);
    dalcs_network_finish(&w->held);
    dalcs_network_finish(&w->reduced);
}

static bool has_states(const struct dalcs_network *n) {
    bool has = false;
    for (int k = 0; k < n->n_systems && !has; k++) {
        has = n->system[k].n_x > 0;
    }
    return has;
}

/* The networks of jumps and of held .ic: of a system file they are there. */
static enum dalcs_status complete(struct whole *w, struct dalcs_session *s) {
    const struct dalcs_network *n = &s->network;
    struct dalcs_equations *e = &w->equations;
    e->held = n->held;
    e->jump[0] = n->jump[0];
    e->jump[1] = n->jump[1];
    e->jumps_are_covered = n->jumps_are_covered;
    if (s->circuit.n_devices == 0) {
        return DALCS_OK;
    }
    if (has_states(n)) {
        const struct dalcs_run_options usual = dalcs_run_options_default();
        const struct dalcs_osnsp_options options = dalcs_osnsp_options_of(&usual);
        DALCS_TRY(dalcs_jumps_build(&w->jumps, &s->circuit, n, &options));
        e->jump[0] = w->jumps.network[0];
        e->jump[1] = w->jumps.network[1];
        e->jumps_are_covered = w->jumps.is_covered;
    }
    const struct dalcs_transient *t = &s->circuit.analyses.transient;
    if (s->circuit.n_initial_conditions > 0 && t->present && !t->use_initial_conditions) {
        DALCS_TRY(dalcs_network_build(
            &w->held, &s->circuit,
            &(struct dalcs_network_options){.clamp_initial_conditions = true}, &s->diag));
        e->held = &w->held;
    }
    return DALCS_OK;
}

static enum dalcs_status eliminate(struct whole *w, struct dalcs_session *s) {
    const char *because;
    if (s->circuit.control.n_smooth > 0) {
        dalcs_diag_add(&s->diag, DALCS_WARNING, NULL, "the DALCS can be written: --form dalcs",
                       "z cannot be eliminated: products and functions in formulas read it");
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_equations_reduce(&s->network, &w->reduced, &s->arena, &because));
    w->equations.network = &w->reduced;
    if (because != NULL) {
        dalcs_diag_add(&s->diag, DALCS_WARNING, NULL, "the DALCS can be written: --form dalcs",
                       "z cannot be eliminated: %s", because);
    }
    return DALCS_OK;
}

/* ---- Documents in memory ------------------------------------------------------------------- */

struct document {
    FILE *f;
    char *text;
    size_t length;
};

static enum dalcs_status open_document(struct document *d) {
    *d = (struct document){0};
    d->f = open_memstream(&d->text, &d->length);
    return d->f == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

/* Hands it over and frees it. */
static enum dalcs_status close_document(struct document *d, enum dalcs_status status,
                                        const struct dalcs_equations_files *files) {
    bool lost = ferror(d->f) != 0;
    lost = fclose(d->f) != 0 || lost || d->text == NULL;
    if (status == DALCS_OK) {
        status = lost ? DALCS_E_NOMEM : files->file(files->user, "", d->text, d->length);
    }
    free(d->text);
    return status;
}

/* ---- One step ------------------------------------------------------------------------------ */

static void begin_steps(FILE *f, enum dalcs_equations_format format,
                        const struct dalcs_circuit *circuit) {
    switch (format) {
    case DALCS_EQUATIONS_LATEX:
        dalcs_one_step_begin_latex(f, circuit);
        break;
    case DALCS_EQUATIONS_JSON:
        fputs("{\"dalcs-one-step\": 2,\n\"parts\": [\n", f);
        break;
    default:
        fprintf(f, "%s\n", circuit->title);
        break;
    }
}

static enum dalcs_status write_step(FILE *f, const struct dalcs_equations_options *o, int part,
                                    const struct dalcs_circuit *circuit,
                                    const struct dalcs_one_step *step,
                                    const struct dalcs_equations_files *files) {
    switch (o->format) {
    case DALCS_EQUATIONS_LATEX:
        dalcs_one_step_write_latex(f, circuit, step);
        return DALCS_OK;
    case DALCS_EQUATIONS_JSON:
        fputs(part > 1 ? ",\n" : "", f);
        dalcs_one_step_write_json(f, step);
        return DALCS_OK;
    case DALCS_EQUATIONS_MATRIX_MARKET:
        dalcs_one_step_write_text(f, step);
        return dalcs_one_step_write_market(step, part, files);
    default:
        fputc('\n', f);
        dalcs_one_step_write_text(f, step);
        return DALCS_OK;
    }
}

/* Pairs, unknowns and states up to which M is worked out. */
enum { MOST_COLUMNS = 2000 };

static enum dalcs_status write_steps(struct dalcs_session *s,
                                     const struct dalcs_equations_options *o,
                                     const struct dalcs_equations_files *files) {
    struct document d;
    const struct dalcs_network *n = &s->network;
    for (int k = 0; k < n->n_systems; k++) {
        if (dalcs_system_n_columns(&n->system[k]) > MOST_COLUMNS) {
            dalcs_diag_add(
                &s->diag, DALCS_ERROR, NULL, NULL,
                "the one-step problem of more than %d unknowns is not written: M is dense",
                MOST_COLUMNS);
            return DALCS_E_LIMIT;
        }
    }
    DALCS_TRY(open_document(&d));
    begin_steps(d.f, o->format, &s->circuit);
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < n->n_systems && status == DALCS_OK; k++) {
        struct dalcs_one_step step;
        status = dalcs_one_step_of(&step, &n->system[k], o->step);
        if (status == DALCS_OK) {
            status = write_step(d.f, o, n->n_systems > 1 ? k + 1 : 0, &s->circuit, &step, files);
            dalcs_one_step_finish(&step);
        }
    }
    fputs(o->format == DALCS_EQUATIONS_LATEX  ? "\\end{document}\n"
          : o->format == DALCS_EQUATIONS_JSON ? "\n]}\n"
                                              : "",
          d.f);
    return close_document(&d, status, files);
}

/* ---- All together -------------------------------------------------------------------------- */

static enum dalcs_status write_equations(struct whole *w, const struct dalcs_equations_options *o,
                                         const struct dalcs_equations_files *files) {
    struct document d;
    switch (o->format) {
    case DALCS_EQUATIONS_SYSTEM:
        return dalcs_equations_write_system(&w->equations, DALCS_AS_CARDS, files);
    case DALCS_EQUATIONS_JSON:
        return dalcs_equations_write_system(&w->equations, DALCS_AS_JSON, files);
    case DALCS_EQUATIONS_MATRIX_MARKET:
        return dalcs_equations_write_system(&w->equations, DALCS_AS_MATRIX_MARKET, files);
    case DALCS_EQUATIONS_TEXT:
    case DALCS_EQUATIONS_LATEX:
        break;
    }
    DALCS_TRY(open_document(&d));
    if (o->format == DALCS_EQUATIONS_LATEX) {
        dalcs_equations_write_latex(d.f, &w->equations);
    } else {
        dalcs_equations_write_text(d.f, &w->equations);
    }
    return close_document(&d, DALCS_OK, files);
}

enum dalcs_status dalcs_session_equations(struct dalcs_session *session,
                                          const struct dalcs_equations_options *options) {
    if (session->circuit.control.n_delayed > 0) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL, "'%s' is a delay: a DALCS has none",
                       session->circuit.control.delayed[0].name);
        return DALCS_E_NETLIST;
    }
    DALCS_TRY(dalcs_session_apply_values(session));
    const struct dalcs_equations_files files = {.user = options->user,
                                                .file = options->file,
                                                .stem = options->stem == NULL ? "" : options->stem};
    if (options->form == DALCS_FORM_ONE_STEP) {
        if (!(options->step > 0.0) || !isfinite(options->step)) {
            dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, "--step H",
                           "the one-step problem needs a positive step");
            return DALCS_E_OPTION;
        }
        return write_steps(session, options, &files);
    }
    const bool is_file = options->format == DALCS_EQUATIONS_SYSTEM ||
                         options->format == DALCS_EQUATIONS_JSON ||
                         options->format == DALCS_EQUATIONS_MATRIX_MARKET;
    if (session->circuit.control.n_smooth > 0 && is_file) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, "--format text and latex write them",
                       "a system file has no products and functions of columns");
        return DALCS_E_OPTION;
    }
    struct whole w = {.equations = {.circuit = &session->circuit, .network = &session->network}};
    enum dalcs_status status = complete(&w, session);
    if (status == DALCS_OK && options->form == DALCS_FORM_LCS) {
        status = eliminate(&w, session);
    }
    if (status == DALCS_OK) {
        status = write_equations(&w, options, &files);
    }
    whole_finish(&w);
    return status;
}
