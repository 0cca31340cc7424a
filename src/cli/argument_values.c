/* argument_values.c - what stands behind the options of `dalcs run`, checked without a file. */
#include "argument_values.h"

#include "figure.h"
#include "memory.h"
#include "settings.h"
#include "table.h"
#include "verb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What makes a file of this name, for which -o is not. */
static const char *who_writes(const char *path) {
    static const char *const other[][2] = {
        {".parquet", "; in Python dalcs.run(...).to_pandas().to_parquet(...) writes it"},
        {".feather", "; in Python dalcs.run(...).to_pandas().to_feather(...) writes it"},
        {".xlsx", "; in Python dalcs.run(...).to_pandas().to_excel(...) writes it"},
        {".h5", "; in Python dalcs.run(...).to_pandas().to_hdf(...) writes it"},
        {".hdf5", "; in Python dalcs.run(...).to_pandas().to_hdf(...) writes it"},
        {".nc", "; in Python dalcs.run(...).to_xarray().to_netcdf(...) writes it"},
        {".npy", "; in Python dalcs.run(...).values is an array of NumPy"},
        {".npz", "; in Python dalcs.run(...).values is an array of NumPy"},
        {".mat", "; in Python dalcs.run(...).values goes into scipy.io.savemat"},
        {".json", "; --report FILE.json says what the run did"},
        {".svg", "; --plot FILE.svg draws"},
        {".png", "; --plot FILE.png draws"},
        {".pdf", "; --plot FILE.pdf draws"},
        {".html", "; 'dalcs plot' makes a page of a .raw file"}};
    const char *dot = strrchr(path, '.');
    for (size_t k = 0; dot != NULL && k < sizeof other / sizeof other[0]; k++) {
        if (strcasecmp(dot, other[k][0]) == 0) {
            return other[k][1];
        }
    }
    return "";
}

enum dalcs_status dalcs_argument_output(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *path) {
    if (strcmp(path, "none") == 0) {
        arguments->files.no_waveforms = true;
        return DALCS_OK;
    }
    if (!dalcs_table_find_format(path)) {
        dalcs_cli_error(cli, "unknown format of '%s': name it .csv or .raw%s", path,
                        who_writes(path));
        return DALCS_E_OPTION;
    }
    arguments->files.output[arguments->files.n_outputs++] = path;
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_method(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    size_t n = 0;
    for (; dalcs_method_name(n); n++) {
        if (strcmp(dalcs_method_name(n), text) == 0) {
            arguments->method.name = text;
            return DALCS_OK;
        }
    }
    fprintf(cli->err, "dalcs: error: --method: unknown method '%s'; the methods are:", text);
    for (size_t i = 0; i < n; i++) {
        fprintf(cli->err, " %s", dalcs_method_name(i));
    }
    fputc('\n', cli->err);
    return DALCS_E_OPTION;
}

static enum dalcs_status parse_number(const struct dalcs_cli *cli, const char *name,
                                      const char *text, double *value) {
    if (dalcs_parse_number(text, value) != DALCS_OK) {
        dalcs_cli_error(cli, "%s: '%s' is not a number; write 1u or 1e-6", name, text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_tolerance(struct dalcs_arguments *arguments,
                                           const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(parse_number(cli, "--tol", text, &arguments->method.tolerance));
    if (arguments->method.tolerance < DALCS_TOLERANCE_MIN ||
        arguments->method.tolerance > DALCS_TOLERANCE_MAX) {
        dalcs_cli_error(cli, "--tol: '%s' does not lie between %g and %g", text,
                        DALCS_TOLERANCE_MIN, DALCS_TOLERANCE_MAX);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_stages(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    double value = 0.0;
    if (dalcs_parse_number(text, &value) != DALCS_OK || !DALCS_HAS_STAGES(value)) {
        dalcs_cli_error(cli, "--stages: '%s' is none of 1, 3, 5, 7, 9", text);
        return DALCS_E_OPTION;
    }
    arguments->method.stages = (int)value;
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_step(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(parse_number(cli, "--step", text, &arguments->method.step));
    if (!(arguments->method.step > 0.0)) {
        dalcs_cli_error(cli, "--step: '%s' must be greater than 0", text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

/* Of a largest value; or_none: what else there is, "" or ", or none". */
static enum dalcs_status parse_part(const struct dalcs_cli *cli, const char *name, const char *text,
                                    const char *or_none, double *value) {
    DALCS_TRY(parse_number(cli, name, text, value));
    if (!(*value > 0.0 && *value < 1.0)) {
        dalcs_cli_error(cli, "%s: '%s' must be greater than 0 and less than 1%s", name, text,
                        or_none);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_fill(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    if (strcmp(text, "none") == 0) {
        arguments->rows.fill = INFINITY;
        return DALCS_OK;
    }
    return parse_part(cli, "--fill", text, ", or none", &arguments->rows.fill);
}

enum dalcs_status dalcs_argument_curve(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli, const char *text) {
    if (strcmp(text, "cubics") != 0 && strcmp(text, "lines") != 0) {
        dalcs_cli_error(cli, "--curve: '%s' is neither cubics nor lines", text);
        return DALCS_E_OPTION;
    }
    arguments->rows.curve = text;
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_audit(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli, const char *text) {
    static const char *const name[] = {"sample", "full", "off"};
    for (int k = 0; k < 3; k++) {
        if (strcmp(text, name[k]) == 0) {
            arguments->audit = (enum dalcs_audit_mode)k;
            return DALCS_OK;
        }
    }
    dalcs_cli_error(cli, "--audit: '%s' is none of sample, full and off", text);
    return DALCS_E_OPTION;
}

bool dalcs_argument_is_page(const char *path) {
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".html") == 0 || strcasecmp(dot, ".htm") == 0);
}

/* FROM:TO, either of which may be left out; NULL: the netlist's window. */
enum dalcs_status dalcs_argument_losses(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    if (arguments->bode.is_asked || arguments->envelope.is_asked) {
        dalcs_cli_error(cli, "--losses is an option of 'dalcs run' and 'dalcs steady'");
        return DALCS_E_OPTION;
    }
    if (arguments->steady.is_asked && text != NULL) {
        dalcs_cli_error(
            cli,
            "--losses: a steady state has the losses of its whole orbit: leave the window out");
        return DALCS_E_OPTION;
    }
    arguments->losses.is_asked = true;
    arguments->losses.from = text == NULL ? (double)NAN : 0.0;
    arguments->losses.to = INFINITY;
    if (text == NULL) {
        return DALCS_OK;
    }
    const char *colon = strchr(text, ':');
    char from[64];
    if (colon == NULL || (size_t)(colon - text) >= sizeof from) {
        dalcs_cli_error(cli, "--losses: '%s' is not FROM:TO; write 10m:20m", text);
        return DALCS_E_OPTION;
    }
    memcpy(from, text, (size_t)(colon - text));
    from[colon - text] = '\0';
    if (from[0] != '\0') {
        DALCS_TRY(parse_number(cli, "--losses", from, &arguments->losses.from));
    }
    if (colon[1] != '\0') {
        DALCS_TRY(parse_number(cli, "--losses", colon + 1, &arguments->losses.to));
    }
    if (!(arguments->losses.from >= 0.0 && arguments->losses.from < arguments->losses.to)) {
        dalcs_cli_error(cli, "--losses: '%s' is no window: write FROM:TO with 0 <= FROM < TO",
                        text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_losses_plot(struct dalcs_arguments *arguments,
                                             const struct dalcs_cli *cli, const char *path) {
    if (arguments->bode.is_asked || arguments->envelope.is_asked) {
        dalcs_cli_error(cli, "--losses-plot is an option of 'dalcs run' and 'dalcs steady'");
        return DALCS_E_OPTION;
    }
    arguments->losses.plot = path;
    if (!dalcs_figure_can_write(path)) {
        dalcs_cli_error(cli, "--losses-plot: unknown format of '%s': name it .svg, .png or .pdf",
                        path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_compress(struct dalcs_arguments *arguments,
                                          const struct dalcs_cli *cli, const char *text) {
    return parse_part(cli, "--compress", text, "", &arguments->rows.compress);
}

enum dalcs_status dalcs_argument_set(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                     const char *text) {
    arguments->set[arguments->n_set++] = text;
    return dalcs_settings_check(cli, text);
}

enum dalcs_status dalcs_argument_plot(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *path) {
    const bool may_be_page =
        arguments->steady.is_asked || arguments->bode.is_asked || arguments->envelope.is_asked;
    arguments->files.plot = path;
    if (!dalcs_figure_can_write(path) && !(dalcs_argument_is_page(path) && may_be_page)) {
        dalcs_cli_error(cli, "--plot: unknown format of '%s': name it %s", path,
                        may_be_page ? ".svg, .png, .pdf or .html" : ".svg, .png or .pdf");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_shard(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli, const char *text) {
    char end;
    if (strspn(text, "0123456789/") != strlen(text) ||
        sscanf(text, "%zu/%zu%c", &arguments->variants.shard, &arguments->variants.n_shards,
               &end) != 2 ||
        arguments->variants.shard < 1 || arguments->variants.shard > arguments->variants.n_shards) {
        dalcs_cli_error(
            cli,
            "--shard: '%s' is not K/N with K from 1 to N; write 3/16 for the third of 16 parts",
            text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_seed(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    if (strspn(text, "0123456789") != strlen(text) || strlen(text) > 15 ||
        dalcs_parse_number(text, &arguments->variants.seed) != DALCS_OK) {
        dalcs_cli_error(cli, "--seed: '%s' is no whole number of up to 15 digits", text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_measures(struct dalcs_arguments *arguments,
                                          const struct dalcs_cli *cli, const char *path) {
    arguments->files.measures = path;
    if (arguments->envelope.is_asked) {
        dalcs_cli_error(cli, "--measures is a table of .meas, which an envelope leaves out");
        return DALCS_E_OPTION;
    }
    if (dalcs_table_find_format(path) != &dalcs_csv_format) {
        dalcs_cli_error(cli, "--measures: '%s' is no name of a table: name it .csv", path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}
