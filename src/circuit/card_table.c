/* card_table.c - the readers of the cards, and cards that are not supported.
 *
 * What other simulators know is named as such: "not supported yet", or not the business of a
 * simulator of ideal diodes. The cards inside a refused block are not looked at. Parameters, subcircuits,
 * conditions and included files are gone before: language/ has expanded them. */
#include "card_table.h"

#include "slips.h"

#include "element_cards.h"

#include <string.h>

struct dot_card {
    const char *name;
    enum dalcs_card_class class;
    const char *refused; /* what it is, when it is not supported yet */
    const char *hint;
    unsigned hides;        /* what a refused card may have defined */
    const char *block_end; /* the card that ends the block it starts */
};

enum {
    NOTHING = 0,
    ELEMENTS = DALCS_HIDDEN_ELEMENTS,
    MODELS = DALCS_HIDDEN_MODELS,
    ANALYSES = DALCS_HIDDEN_ANALYSES,
    ALL = DALCS_HIDDEN_ALL
};

static const struct dot_card DOT_CARDS[] = {
    {".model", DALCS_CARD_MODEL, NULL, NULL, NOTHING, NULL},
    {".tran", DALCS_CARD_TRAN, NULL, NULL, NOTHING, NULL},
    {".pss", DALCS_CARD_PSS, NULL, NULL, NOTHING, NULL},
    {".env", DALCS_CARD_ENV, NULL, NULL, NOTHING, NULL},
    {".op", DALCS_CARD_OP, NULL, NULL, NOTHING, NULL},
    {".dc", DALCS_CARD_DC, NULL, NULL, NOTHING, NULL},
    {".ac", DALCS_CARD_AC, NULL, NULL, NOTHING, NULL},
    {".sens", DALCS_CARD_SENS, NULL, NULL, NOTHING, NULL},
    {".tf", DALCS_CARD_TRANSFER, NULL, NULL, NOTHING, NULL},
    {".step", DALCS_CARD_STEP, NULL, NULL, NOTHING, NULL},
    {".mc", DALCS_CARD_MC, NULL, NULL, NOTHING, NULL},
    {".wcase", DALCS_CARD_WORST_CASE, NULL, NULL, NOTHING, NULL},
    {".wc", DALCS_CARD_WORST_CASE, NULL, NULL, NOTHING, NULL},
    {".nodeset", DALCS_CARD_NODESET, NULL, NULL, NOTHING, NULL},
    {".control", DALCS_CARD_NONE, NULL, NULL, NOTHING, NULL},
    {".endc", DALCS_CARD_NONE, NULL, NULL, NOTHING, NULL},
    {".options", DALCS_CARD_OPTIONS, NULL, NULL, NOTHING, NULL},
    {".option", DALCS_CARD_OPTIONS, NULL, NULL, NOTHING, NULL},
    {".temp", DALCS_CARD_TEMPERATURE, NULL, NULL, NOTHING, NULL},
    {".opt", DALCS_CARD_OPTIONS, NULL, NULL, NOTHING, NULL},
    {".ic", DALCS_CARD_IC, NULL, NULL, NOTHING, NULL},
    {".save", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".print", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".plot", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".probe", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".probe64", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".probe/csdf", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".meas", DALCS_CARD_MEASURE, NULL, NULL, NOTHING, NULL},
    {".measure", DALCS_CARD_MEASURE, NULL, NULL, NOTHING, NULL},
    {".four", DALCS_CARD_FOURIER, NULL, NULL, NOTHING, NULL},
    {".fourier", DALCS_CARD_FOURIER, NULL, NULL, NOTHING, NULL},
    {".losses", DALCS_CARD_LOSSES, NULL, NULL, NOTHING, NULL},
    {".switchloss", DALCS_CARD_SWITCHLOSS, NULL, NULL, NOTHING, NULL},
    {".backanno", DALCS_CARD_NONE, NULL, NULL, NOTHING, NULL},

    {".data", DALCS_CARD_NONE, "tables of parameters",
     "write .step param name list value value ...", NOTHING, ".enddata"},
    {".enddata", DALCS_CARD_NONE, "tables of parameters", NULL, NOTHING, NULL},
    {".distribution", DALCS_CARD_NONE, "distributions by tables",
     "write table(rand(), 0, smallest, ..., 1, largest) in a .param", NOTHING, NULL},
    {".sampling", DALCS_CARD_NONE, "Xyce's samplings",
     "write agauss, aunif, ... in expressions, and .mc with the number of runs", NOTHING, NULL},
    {".embeddedsampling", DALCS_CARD_NONE, "Xyce's samplings",
     "write agauss, aunif, ... in expressions, and .mc with the number of runs", NOTHING, NULL},
    {".fft", DALCS_CARD_NONE, "spectra by a card",
     ".four frequency v(out) computes harmonics; 'dalcs plot FILE --spectrum frequency' draws them",
     NOTHING, NULL},
    {".machine", DALCS_CARD_NONE, "state machines",
     "A elements with SRFLOP, DFLOP or COUNTER are flip-flops and counters", ELEMENTS,
     ".endmachine"},
    {".endmachine", DALCS_CARD_NONE, "state machines", NULL, NOTHING, NULL},
    {".alter", DALCS_CARD_NONE, "altered runs", "write .step, or alter in a .control block",
     NOTHING, NULL},
};

/* Without a meaning for ideal elements; accepted. */
static const char *const IGNORED[] = {".width",  ".prot", ".unprot", ".preprocess",
                                      ".stmlib", ".list", ".status"};

/* What is computed from an .ac besides its signals. */
static const char NETWORK_PARAMETERS[] = ".net";

/* LTspice's sound files, an output beside others. */
static const char SOUND[] = ".wave";

/* LTspice's file of a bias point: one that the run writes, or takes first guesses from. */
static const char *const BIAS[] = {".savebias", ".loadbias"};

/* Xyce's values of formulas at the end of each step. */
static const char RESULT[] = ".result";

/* Analyses that this simulator will not have. */
static const char *const NEVER[] = {".noise", ".pz", ".disto", ".sp", ".hb", ".stab", ".ferret"};

/* Elements by letter that are not supported. */
static const char *refused_element(char letter) {
    switch (letter) {
    case 'j':
        return "transistors";
    case 'n':
        return "compiled models";
    case 'o':
        return "transmission lines with losses";
    case 'u':
        return "distributed RC lines, and the digital devices of PSpice and Xyce,";
    case 'y':
        return "lossy lines of ngspice, and Xyce's Y devices,";
    case 'p':
        return "coupled lines, and ports,";
    default:
        return NULL;
    }
}

static const char *hint_of_element(char letter) {
    switch (letter) {
    case 'j':
        return "write an ideal switch S, with a diode D across it for a body diode";
    case 'u':
    case 'y':
        return "Aname in1 in2 0 0 0 inverse out 0 AND is a gate, with DFLOP and others a "
               "flip-flop; "
               "Tname a b c d Z0=ohms TD=seconds is a line without losses";
    case 'o':
    case 'p':
        return "Tname a b c d Z0=ohms TD=seconds is a line without losses";
    default:
        return NULL;
    }
}

static const char CARDS[] =
    "the cards are: .model .ic .tran .op .dc .ac .tf .step .options .save .print .end";

static void report_unknown(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const char *names[sizeof DOT_CARDS / sizeof DOT_CARDS[0]];
    const size_t n = sizeof DOT_CARDS / sizeof DOT_CARDS[0];
    for (size_t k = 0; k < n; k++) {
        names[k] = DOT_CARDS[k].name;
    }
    dalcs_builder_error(builder, name,
                        dalcs_builder_suggest_of(builder, names, n, name->text, CARDS),
                        "unknown card '%s'", name->text);
}

static enum dalcs_card_class classify_dot(struct dalcs_card_table *table,
                                          const struct dalcs_token *name) {
    struct dalcs_builder *builder = table->builder;
    for (size_t k = 0; k < sizeof DOT_CARDS / sizeof DOT_CARDS[0]; k++) {
        const struct dot_card *card = &DOT_CARDS[k];
        if (strcmp(card->name, name->text) != 0) {
            continue;
        }
        if (card->refused != NULL) {
            dalcs_builder_error(builder, name, card->hint, "%s are not supported yet (%s)",
                                card->refused, card->name);
            builder->hidden |= card->hides;
            table->block_begin = card->name;
            table->block_end = card->block_end;
            table->block_depth = card->block_end != NULL;
        }
        return card->class;
    }
    if (dalcs_builder_is_one_of(name->text, IGNORED, sizeof IGNORED / sizeof IGNORED[0])) {
        dalcs_builder_note(builder, name, NULL, "%s has no meaning here and is ignored",
                           name->text);
    } else if (strcmp(name->text, NETWORK_PARAMETERS) == 0) {
        dalcs_builder_warn(builder, name, "v(out)/i(v1) of an .ac is an impedance",
                           "network parameters (.net) are not computed: the card is left out");
    } else if (strcmp(name->text, SOUND) == 0) {
        dalcs_builder_warn(builder, name, "-o file.csv has the waveforms",
                           "sound files (.wave) are not written: the card is left out");
    } else if (dalcs_builder_is_one_of(name->text, BIAS, sizeof BIAS / sizeof BIAS[0])) {
        dalcs_builder_warn(builder, name, ".ic v(node)=volts sets where a run begins",
                           "files of bias points (%s) are not used: the card is left out",
                           name->text);
    } else if (strcmp(name->text, RESULT) == 0) {
        dalcs_builder_warn(builder, name, ".meas tran name FIND formula AT=time is one",
                           "no file of results (.result) is written: the card is left out");
    } else if (dalcs_builder_is_one_of(name->text, NEVER, sizeof NEVER / sizeof NEVER[0])) {
        dalcs_builder_error(builder, name, "use .tran, .op, .dc, .ac or .tf",
                            "%s is not an analysis of ideal-diode circuits", name->text);
        builder->hidden |= DALCS_HIDDEN_ANALYSES;
    } else {
        report_unknown(builder, name);
        builder->hidden |= DALCS_HIDDEN_ALL;
    }
    return DALCS_CARD_NONE;
}

static enum dalcs_card_class classify_element(struct dalcs_card_table *table,
                                              const struct dalcs_card *card) {
    struct dalcs_builder *builder = table->builder;
    const struct dalcs_token *name = card->token;
    const char letter = card->letter;
    if (dalcs_slip_lacks_dot(card)) {
        builder->hidden |= DALCS_HIDDEN_ALL;
        dalcs_builder_error(builder, name,
                            dalcs_builder_hint(builder, "did you mean '.%s'?", name->text),
                            "'%s' lacks the '.' of a card", name->text);
        return DALCS_CARD_NONE;
    }
    if (letter == 'k') {
        const size_t n_coils = (size_t)dalcs_coupling_count_coils(card);
        table->n_pairs += n_coils * (n_coils - 1) / 2;
        return DALCS_CARD_COUPLING;
    }
    if (strchr("rlcviefghdswabmzqt", letter) != NULL) {
        dalcs_card_table_count(table, card);
        return DALCS_CARD_ELEMENT;
    }
    const char *what = refused_element(letter);
    builder->hidden |= DALCS_HIDDEN_ELEMENTS;
    if (what != NULL) {
        dalcs_builder_error(builder, name, hint_of_element(letter),
                            "%s are not supported yet ('%s')", what, name->text);
    } else {
        dalcs_builder_error(builder, name, "'*' starts a comment line, '+' continues a card",
                            "'%s' is neither an element nor a card that starts with '.'",
                            name->text);
    }
    return DALCS_CARD_NONE;
}

/* Does a model name either of these parameters? */
static bool is_model_with(const struct dalcs_card *card, const char *one, const char *other) {
    bool found = false;
    for (int k = 1; k < card->n && strcmp(card->token->text, ".model") == 0; k++) {
        found = found || strcmp(card->token[k].text, one) == 0 ||
                strcmp(card->token[k].text, other) == 0;
    }
    return found;
}

enum dalcs_card_class dalcs_card_table_classify(struct dalcs_card_table *table,
                                                const struct dalcs_card *card) {
    const struct dalcs_token *name = card->token;
    if (name->kind != DALCS_TOKEN_WORD) {
        if (table->block_end == NULL && name->kind != DALCS_TOKEN_BAD) {
            dalcs_builder_error(table->builder, name, NULL, "a card cannot start with '%s'",
                                name->text);
        }
        table->builder->hidden |= DALCS_HIDDEN_ALL;
        return DALCS_CARD_NONE;
    }
    if (table->block_end != NULL) {
        table->block_depth += strcmp(name->text, table->block_begin) == 0;
        table->block_depth -= strcmp(name->text, table->block_end) == 0;
        if (table->block_depth == 0) {
            table->block_end = NULL;
        }
        return DALCS_CARD_NONE;
    }
    table->has_series = table->has_series || is_model_with(card, "lser", "vser");
    table->has_limits = table->has_limits || is_model_with(card, "ilimit", "revilimit");
    const bool is_transfer = strcmp(name->text, ".tf") == 0;
    table->n_inner += is_transfer;
    table->n_stimuli += is_transfer;
    table->n_inner += card->letter == '.' ? dalcs_card_table_count_formulas(card) : 0;
    return card->letter == '.' ? classify_dot(table, name) : classify_element(table, card);
}
