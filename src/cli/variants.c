/* variants.c - many variants: their table in a file and for people, what failed, what ended it early. */
#include "variants.h"

#include "atomic_file.h"
#include "csv_cells.h"
#include "memory.h"
#include "run_statistics.h"
#include "settings.h"
#include "variants_file.h"
#include "variants_pool.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Lines for people; different warnings of variants that are printed. */
enum { MOST_LINES = 200, MOST_WARNINGS = 20 };

struct variants {
    const struct dalcs_cli *cli;
    const struct dalcs_arguments *arguments;
    struct dalcs_variants_pool pool;
    struct dalcs_variants_file file;
    size_t n_done, n_failed; /* in this run */
    struct dalcs_run_statistics statistics;
    char *said[MOST_WARNINGS];
    size_t n_said, n_unsaid;
    int error; /* of the disk, errno */
};

enum dalcs_status dalcs_variants_ask(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_session *session, bool has_script,
                                     bool *wanted) {
    const bool has_steps = dalcs_session_request(session).n_steps > 1;
    const bool is_table =
        arguments->files.no_waveforms && arguments->files.n_outputs == 0 &&
        arguments->files.measures != NULL && !dalcs_is_standard_output(arguments->files.measures) &&
        arguments->files.report == NULL && arguments->files.plot == NULL &&
        !arguments->losses.is_asked && arguments->losses.plot == NULL && !arguments->energy &&
        !arguments->steady.is_asked && !arguments->bode.is_asked && !arguments->batch.is_asked;
    const bool can_read = strcmp(arguments->netlist, "-") != 0;
    const bool has_corners = dalcs_session_request(session).worst_case;
    const bool is_asked = arguments->variants.n_shards > 0 || arguments->variants.resume ||
                          (arguments->variants.jobs > 0 && !has_corners);
    *wanted = has_steps && is_table && can_read && !has_script && arguments->variants.only == 0;
    if (*wanted || !is_asked) {
        return DALCS_OK;
    }
    dalcs_cli_error(cli, "--shard, --resume and --jobs need many variants: %s",
                    !is_table ? "write -o none --measures FILE.csv, and no other result"
                    : !can_read
                        ? "each thread reads the netlist, so give the name of a file in place of -"
                    : arguments->variants.only > 0 ? "--only is one of them"
                    : has_script ? "here a .control block runs the analyses, one after the other"
                                 : "the netlist has no .step and no .mc");
    return DALCS_E_OPTION;
}

static char *begin_of(void *user, size_t row) {
    const struct variants *v = user;
    return dalcs_variant_begin(&v->pool, v->pool.first + row);
}

/* Names of --set, of .step, of what is drawn, of .meas, and "error". */
static char *write_header(const struct variants *v) {
    const struct dalcs_session *session = v->pool.session;
    char *text = NULL;
    const char *name;
    double value;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) {
        return NULL;
    }
    struct dalcs_csv_cells cells = {.out = out, .decimal = v->pool.decimal};
    for (size_t k = 0; k < v->arguments->n_set; k++) {
        size_t length;
        dalcs_settings_value(v->arguments->set[k], &length);
        dalcs_csv_text(&cells, v->arguments->set[k], length);
    }
    for (size_t k = 0; (name = dalcs_session_step_parameter(session, 0, k, &value)) != NULL; k++) {
        dalcs_csv_text(&cells, name, strlen(name));
    }
    for (size_t k = 0; (name = dalcs_session_drawn(session, k, &value)) != NULL; k++) {
        dalcs_csv_text(&cells, name, strlen(name));
    }
    for (size_t k = 0; (name = dalcs_session_measure_name(session, k)) != NULL; k++) {
        dalcs_csv_text(&cells, name, strlen(name));
    }
    dalcs_csv_text(&cells, "error", strlen("error"));
    dalcs_csv_end(&cells);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

/* The same for the terminal. */
static void print_header(const struct variants *v) {
    const struct dalcs_session *session = v->pool.session;
    const char *name;
    double value;
    fprintf(v->cli->out, "\n ");
    for (size_t k = 0; (name = dalcs_session_step_parameter(session, 0, k, &value)) != NULL; k++) {
        fprintf(v->cli->out, " %*s", dalcs_variant_width(name), name);
    }
    for (size_t k = 0; (name = dalcs_session_measure_name(session, k)) != NULL; k++) {
        fprintf(v->cli->out, " %*s", dalcs_variant_width(name), name);
    }
    fputc('\n', v->cli->out);
}

/* Once each: most variants have the same. */
static enum dalcs_status tell_warnings(struct variants *v, const char *text) {
    for (; *text != '\0'; text += strlen(text) + 1) {
        bool is_new = true;
        for (size_t k = 0; k < v->n_said && is_new; k++) {
            is_new = strcmp(v->said[k], text) != 0;
        }
        if (is_new && v->n_said == MOST_WARNINGS) {
            v->n_unsaid++;
        } else if (is_new) {
            v->said[v->n_said] = strdup(text);
            if (v->said[v->n_said] == NULL) {
                return DALCS_E_NOMEM;
            }
            v->n_said++;
            dalcs_cli_write_message(v->cli, text);
        }
    }
    return DALCS_OK;
}

static enum dalcs_status take(void *user, const struct dalcs_variant *variant) {
    struct variants *v = user;
    if (dalcs_variants_file_row(&v->file, variant->row) != DALCS_OK) {
        v->error = errno != 0 ? errno : EIO;
        return DALCS_E_IO;
    }
    if (!v->arguments->quiet && v->n_done < MOST_LINES) {
        fprintf(v->cli->out, "%s\n", variant->line);
    }
    dalcs_run_statistics_add(&v->statistics, variant->value);
    v->n_done++;
    v->n_failed += variant->failed ? 1 : 0;
    return tell_warnings(v, variant->warnings);
}

static const char *plural(size_t n) {
    return n == 1 ? "" : "s";
}

static void tell_failed(const struct variants *v, const char *where) {
    const size_t n_failed = v->n_failed + v->file.n_failed;
    const size_t n = v->n_done + v->file.n_rows;
    if (n_failed > 0) {
        dalcs_cli_error(v->cli, "%zu of %zu variant%s failed: the column 'error' of '%s' says why",
                        n_failed, n, plural(n), where);
    }
}

/* It is not all there: what is, and how to go on. */
static void tell_rest(const struct variants *v, enum dalcs_status status) {
    const size_t n = v->n_done + v->file.n_rows;
    if (status == DALCS_E_IO) {
        dalcs_cli_error(v->cli, "cannot write '%s': %s", v->file.partial, strerror(v->error));
    } else if (status != DALCS_E_CANCELLED) {
        dalcs_cli_error(v->cli, "%s", dalcs_status_text(status));
    }
    fprintf(v->cli->err,
            "dalcs: %s after %zu of %zu variants, which are in '%s': --resume goes on from there\n",
            status == DALCS_E_CANCELLED ? "interrupted" : "ended", n, v->pool.end - v->pool.first,
            v->file.partial);
    tell_failed(v, v->file.partial);
}

/* A mean over chosen values has no meaning. */
static bool is_random(const struct variants *v) {
    double value;
    return dalcs_session_drawn(v->pool.session, 0, &value) != NULL && v->n_done > 1;
}

static enum dalcs_status run_rest(struct variants *v) {
    if (!v->arguments->quiet) {
        print_header(v);
    }
    struct dalcs_variants_pool rest = v->pool;
    rest.first += v->file.n_rows;
    enum dalcs_status status = rest.first < rest.end ? dalcs_variants_pool_run(&rest) : DALCS_OK;
    if (v->n_unsaid > 0) {
        fprintf(v->cli->err, "dalcs: warning: and %zu more of other variants\n", v->n_unsaid);
    }
    if (status == DALCS_OK && dalcs_variants_file_commit(&v->file) != DALCS_OK) {
        v->error = errno;
        status = DALCS_E_IO;
    }
    if (status != DALCS_OK) {
        tell_rest(v, status);
        return status;
    }
    if (!v->arguments->quiet) {
        if (v->n_done > MOST_LINES) {
            fprintf(v->cli->out, "  ... and %zu more\n", v->n_done - MOST_LINES);
        }
        if (is_random(v)) {
            dalcs_run_statistics_write(v->cli->out, &v->statistics, v->pool.session);
        }
        fprintf(v->cli->out, "  wrote     %s\n\n", v->file.path);
    }
    tell_failed(v, v->file.path);
    return v->n_failed + v->file.n_failed > 0 ? DALCS_NOT_CONVERGED : DALCS_OK;
}

static void finish(struct variants *v) {
    dalcs_run_statistics_finish(&v->statistics);
    dalcs_variants_file_finish(&v->file);
    for (size_t k = 0; k < v->n_said; k++) {
        free(v->said[k]);
    }
}

enum dalcs_status dalcs_variants_run(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_session *session,
                                     const struct dalcs_run_options *options) {
    const size_t n = dalcs_session_request(session).n_steps;
    const size_t n_shards = arguments->variants.n_shards > 0 ? arguments->variants.n_shards : 1;
    const size_t shard = arguments->variants.n_shards > 0 ? arguments->variants.shard : 1;
    struct dalcs_decimal decimal;
    dalcs_decimal_init(&decimal);
    const bool goes_on = arguments->variants.resume || dalcs_crashes_go_on();
    struct dalcs_crashes crashes = {0};
    struct variants v = {
        .cli = cli, .arguments = arguments, .file = {.path = arguments->files.measures}};
    /* Neighbours stay together: the parts one after the other are the whole table. */
    v.pool = (struct dalcs_variants_pool){
        .cli = cli,
        .arguments = arguments,
        .session = session,
        .options = options,
        .decimal = &decimal,
        .first = n / n_shards * (shard - 1) + n % n_shards * (shard - 1) / n_shards,
        .end = n / n_shards * shard + n % n_shards * shard / n_shards,
        .take = take,
        .user = &v};
    while (dalcs_session_measure_name(session, v.pool.n_measures) != NULL) {
        v.pool.n_measures++;
    }
    char *header = write_header(&v);
    enum dalcs_status status = dalcs_run_statistics_begin(&v.statistics, v.pool.n_measures);
    status = status != DALCS_OK || header == NULL
                 ? DALCS_E_NOMEM
                 : dalcs_variants_file_open(&v.file, cli, header, goes_on, begin_of, &v);
    if (status == DALCS_OK && !v.file.is_complete) {
        status = dalcs_crashes_watch(&crashes, v.file.partial, goes_on);
        v.pool.crashes = &crashes;
    }
    if (status == DALCS_E_NOMEM) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    } else if (status == DALCS_OK && v.file.is_complete) {
        if (!arguments->quiet) {
            fprintf(cli->out, "  '%s' is complete\n", arguments->files.measures);
        }
    } else if (status == DALCS_OK) {
        status = run_rest(&v);
    }
    free(header);
    dalcs_crashes_finish(&crashes, status == DALCS_OK || status == DALCS_NOT_CONVERGED);
    finish(&v);
    return status;
}
