/* argument_options.c - the options of `dalcs run`, each with what takes its value. */
#include "argument_options.h"
#include "argument_values.h"

#include "status.h"
#include "verb.h"

#include <getopt.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

static enum dalcs_status take_sideband(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli, const char *text) {
    if (dalcs_parse_number(text, &arguments->bode.sideband) != DALCS_OK ||
        !(fabs(arguments->bode.sideband) <= DALCS_MOST_SIDEBAND) ||
        arguments->bode.sideband != rint(arguments->bode.sideband)) {
        dalcs_cli_error(cli, "--sideband: '%s' is no whole number, at most %d of them away", text,
                        (int)DALCS_MOST_SIDEBAND);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take_injection(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    arguments->bode.loop_is_loaded = strcmp(text, "both") == 0;
    if (!arguments->bode.loop_is_loaded && strcmp(text, "voltage") != 0) {
        dalcs_cli_error(cli, "--injection: '%s' is neither voltage nor both", text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take_dialect(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    return dalcs_verb_take_dialect(cli, text, &arguments->dialect);
}

static enum dalcs_status take_from(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                   const char *text) {
    return dalcs_verb_take_positive(cli, "--from", text, &arguments->bode.from);
}

static enum dalcs_status take_to(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                 const char *text) {
    return dalcs_verb_take_positive(cli, "--to", text, &arguments->bode.to);
}

/* An option's value goes to a reader, or as it is to a place in the arguments. */
typedef enum dalcs_status reader(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                 const char *text);

static const struct known_option {
    const char *name;
    int letter;   /* of its short form; 0: it has none */
    int argument; /* as getopt_long has it */
    reader *read; /* NULL: by the next */

    enum option_kind { OPTION_READ, OPTION_FLAG, OPTION_TEXT, OPTION_COUNT } kind;

    size_t place;
    bool is_of_bode; /* and of no other verb */
} known[] = {

#define PLACE(member) offsetof(struct dalcs_arguments, member)
#define READ(name, read)                                                                           \
    { name, 0, required_argument, read, OPTION_READ, 0, false }
#define FLAG(name, letter, member)                                                                 \
    { name, letter, no_argument, NULL, OPTION_FLAG, PLACE(member), false }
#define TEXT(name, member)                                                                         \
    { name, 0, required_argument, NULL, OPTION_TEXT, PLACE(member), false }
#define COUNT(name, member)                                                                        \
    { name, 0, required_argument, NULL, OPTION_COUNT, PLACE(member), false }
    {"output", 'o', required_argument, dalcs_argument_output, OPTION_READ, 0, false},
    READ("method", dalcs_argument_method),
    READ("dialect", take_dialect),
    READ("tol", dalcs_argument_tolerance),
    READ("stages", dalcs_argument_stages),
    READ("step", dalcs_argument_step),
    READ("fill", dalcs_argument_fill),
    READ("curve", dalcs_argument_curve),
    READ("compress", dalcs_argument_compress),
    READ("at", dalcs_argument_at),
    READ("tran", dalcs_argument_tran),
    READ("tstop", dalcs_argument_tstop),
    TEXT("report", files.report),
    READ("plot", dalcs_argument_plot),
    TEXT("dump", files.dump),
    FLAG("all-signals", 0, files.all_signals),
    FLAG("energy", 0, energy),
    {"losses", 0, optional_argument, dalcs_argument_losses, OPTION_READ, 0, false},
    READ("losses-plot", dalcs_argument_losses_plot),
    READ("audit", dalcs_argument_audit),
    FLAG("ascii", 0, files.ascii),
    FLAG("split-steps", 0, files.split_steps),
    READ("period", dalcs_argument_period),
    READ("stop", dalcs_argument_stop),
    READ("show", dalcs_argument_show),
    {"from", 0, required_argument, take_from, OPTION_READ, 0, true},
    {"to", 0, required_argument, take_to, OPTION_READ, 0, true},
    {"points", 0, required_argument, NULL, OPTION_COUNT, PLACE(bode.points), true},
    {"sensitivity", 0, no_argument, dalcs_argument_sensitivity, OPTION_READ, 0, false},
    READ("bifurcation", dalcs_argument_bifurcation),
    READ("samples", dalcs_argument_samples),
    READ("settle", dalcs_argument_settle),
    READ("multipliers-plot", dalcs_argument_multipliers_plot),
    {"loop", 0, required_argument, NULL, OPTION_TEXT, PLACE(bode.loop), true},
    {"injection", 0, required_argument, take_injection, OPTION_READ, 0, true},
    {"sideband", 0, required_argument, take_sideband, OPTION_READ, 0, true},
    READ("set", dalcs_argument_set),
    READ("measures", dalcs_argument_measures),
    READ("shard", dalcs_argument_shard),
    FLAG("resume", 0, variants.resume),
    COUNT("jobs", variants.jobs),
    READ("seed", dalcs_argument_seed),
    COUNT("only", variants.only),
    FLAG("quiet", 'q', quiet),
    FLAG("help", 'h', help),
#undef PLACE
#undef READ
#undef FLAG
#undef TEXT
#undef COUNT
};

enum { N_KNOWN = sizeof known / sizeof known[0], FIRST_CODE = 256 };

static int code_of(int k) {
    return known[k].letter != 0 ? known[k].letter : FIRST_CODE + k;
}

static enum dalcs_status take(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                              const struct known_option *option) {
    char name[64];
    char *place = (char *)arguments + option->place;
    snprintf(name, sizeof name, "--%s", option->name);
    if (option->is_of_bode && !arguments->bode.is_asked) {
        dalcs_cli_error(cli, "%s is an option of 'dalcs bode'", name);
        return DALCS_E_OPTION;
    }
    switch (option->kind) {
    case OPTION_READ:
        return option->read(arguments, cli, optarg);
    case OPTION_FLAG:
        *(bool *)place = true;
        return DALCS_OK;
    case OPTION_TEXT:
        *(const char **)place = optarg;
        return DALCS_OK;
    default:
        return dalcs_verb_take_count(cli, name, optarg, (size_t *)place);
    }
}

const char *dalcs_arguments_verb(const struct dalcs_arguments *arguments) {
    return arguments->steady.is_asked     ? "steady"
           : arguments->bode.is_asked     ? "bode"
           : arguments->envelope.is_asked ? "envelope"
                                          : "run";
}

enum dalcs_status dalcs_arguments_read_options(struct dalcs_arguments *arguments,
                                               const struct dalcs_cli *cli, int argc, char **argv) {
    struct option option[N_KNOWN + 1] = {{0}};
    for (int k = 0; k < N_KNOWN; k++) {
        option[k] = (struct option){known[k].name, known[k].argument, NULL, code_of(k)};
    }
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code;
         !arguments->help && (code = getopt_long(argc, argv, ":o:qh", option, NULL)) != -1;) {
        int k = 0;
        while (k < N_KNOWN && code_of(k) != code) {
            k++;
        }
        if (k == N_KNOWN) {
            return dalcs_verb_refuse(cli, dalcs_arguments_verb(arguments), option, code, argv);
        }
        DALCS_TRY(take(arguments, cli, &known[k]));
    }
    return DALCS_OK;
}
