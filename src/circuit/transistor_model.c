/* transistor_model.c - cards of MOSFETs (level 1 to 3, VDMOS), IGBTs and bipolar transistors as switches.
 *
 * Read: what says when one is on, what it is then, and its diode. All else on such cards is of the linear region, of
 * charges or of noise, and passed over. Defaults are those of ngspice. */
#include "model_cards.h"
#include "reader.h"
#include "transistor.h"

#include <math.h>
#include <string.h>

enum {
    VTO,
    KP,
    W,
    L,
    RD,
    RS,
    RDS,
    RON,
    VGON,
    IS,
    N,
    RB,
    BV,
    MTRIODE,
    LEVEL,
    TOX,
    UO,
    VCE0,
    VDIODE,
    RDIODE,
    N_PARAMETERS
};

static const char MOSFET_USAGE[] =
    "a MOSFET's model is: .model name NMOS|PMOS|VDMOS [(Vto=volts Kp=A/V^2 Rd=ohms Rs=ohms ...)], "
    "or with Ron=ohms in place of Kp";
static const char IGBT_USAGE[] =
    "an IGBT's model is: .model name NIGBT [(Vt=volts Kp=A/V^2 Vce0=volts Ron=ohms Vdiode=volts "
    "Rdiode=ohms)]";
static const char BIPOLAR_USAGE[] = "a bipolar transistor's model is: .model name NPN|PNP [(...)]";

static bool is_igbt(const struct dalcs_token *type) {
    return strcmp(type->text, "nigbt") == 0;
}

static bool is_bipolar(const struct dalcs_token *type) {
    return strcmp(type->text, "npn") == 0 || strcmp(type->text, "pnp") == 0;
}

/* Of no influence on an ideal switch. */
static bool is_passed_over(const char *name) {
    static const char *const nothing[] = {
        "rg",   "rsh",   "cgs",   "cgd",      "cgso",      "cgdo",     "cgbo",  "cgdmin", "cgdmax",
        "cjo",  "cj",    "cjsw",  "cbd",      "cbs",       "m",        "mj",    "mjsw",   "vj",
        "pb",   "pbsw",  "fc",    "tt",       "ibv",       "nbv",      "a",     "lambda", "gamma",
        "phi",  "nsub",  "nss",   "nfs",      "tpg",       "xj",       "ld",    "wd",     "xl",
        "xw",   "vmax",  "theta", "eta",      "kappa",     "ucrit",    "uexp",  "utra",   "delta",
        "neff", "kf",    "af",    "nlev",     "tnom",      "temp",     "js",    "jssw",   "vds",
        "qg",   "eg",    "xti",   "subthres", "ksubthres", "mu",       "texp0", "texp1",  "tcvth",
        "bex",  "rthjc", "cthj",  "rthca",    "cs",        "subslope", "vtotc", "agd",    "area",
        "bvf",  "bvn",   "cgdj",  "coxd",     "jsne",      "mun",      "mup",   "nb",     "tau",
        "wb",   "vtd",   "cox",   "tf",       "rgs",       "capop",    "alpha", "t_abs"};
    return dalcs_builder_is_label(name) ||
           dalcs_builder_is_one_of(name, nothing, sizeof nothing / sizeof nothing[0]);
}

static bool report_parameter(struct dalcs_reader *reader, const struct dalcs_token *name) {
    const bool is_of_bipolar = reader->usage == BIPOLAR_USAGE;
    if (!is_of_bipolar && !is_passed_over(name->text)) {
        dalcs_builder_warn(reader->builder, name, reader->usage,
                           "'%s' of a transistor's model is not known and has no influence here",
                           name->text);
    }
    return false;
}

/* pchan and nchan may stand anywhere, and before the parenthesis. */
static bool read_all(struct dalcs_reader *reader, struct dalcs_parameter *p, bool *is_p) {
    bool opened = false;
    bool goes_on = true;
    while (goes_on) {
        if (!dalcs_model_read_parameters(reader, p, N_PARAMETERS, report_parameter)) {
            return false;
        }
        const bool is_pchan = dalcs_reader_take_word(reader, "pchan");
        *is_p = *is_p || is_pchan;
        const bool opens = !opened && dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
        opened = opened || opens;
        goes_on = is_pchan || opens || dalcs_reader_take_word(reader, "nchan");
    }
    return !opened || dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
}

static bool check(struct dalcs_builder *builder, const struct dalcs_parameter *p,
                  const char *usage) {
    static const int positive[] = {KP, W, L, RDS, N, BV, MTRIODE, TOX, UO, IS};
    static const int other[] = {RD, RS, RON, RB, VCE0, VDIODE, RDIODE, IS};
    /* IS=0: no body diode; the breakdown is one of that diode, and a base is one */
    const bool may_lack_diode = usage != BIPOLAR_USAGE && isinf(p[BV].value);
    const size_t n_positive = sizeof positive / sizeof positive[0] - (may_lack_diode ? 1 : 0);
    for (size_t k = 0; k < n_positive; k++) {
        if (!(p[positive[k]].value > 0)) {
            dalcs_builder_error(builder, p[positive[k]].place, usage, "'%s' must be positive",
                                p[positive[k]].name);
            return false;
        }
    }
    for (size_t k = 0; k < sizeof other / sizeof other[0]; k++) {
        if (p[other[k]].value < 0) {
            dalcs_builder_error(builder, p[other[k]].place, usage, "'%s' cannot be negative",
                                p[other[k]].name);
            return false;
        }
    }
    if (p[LEVEL].value != 1 && p[LEVEL].value != 2 && p[LEVEL].value != 3) {
        dalcs_builder_error(builder, p[LEVEL].place, "levels 1, 2 and 3 have Vto and Kp",
                            "a MOSFET's model of level %g is of integrated circuits",
                            p[LEVEL].value);
        return false;
    }
    return true;
}

/* Kp, or that of the oxide: level 1 to 3 have Kp = Uo eps/Tox. 0: Ron says what it is on with; on a VDMOS card with Kp
 * that is LTspice's label. */
static double gain_of(const struct dalcs_parameter *p, const struct dalcs_token *type) {
    static const double oxide = 3.9 * 8.8541878128e-12; /* F/m, of silicon dioxide */
    const bool is_vdmos = strcmp(type->text, "vdmos") == 0;
    if (p[RON].place != NULL && (p[KP].place == NULL || !is_vdmos)) {
        return 0;
    }
    if (p[KP].place == NULL && p[TOX].place != NULL && !is_vdmos && !is_igbt(type)) {
        return 1e-4 * p[UO].value * oxide / p[TOX].value;
    }
    return p[KP].value * (is_vdmos ? p[MTRIODE].value : 1);
}

/* Kp without VDMOS's mtriode, which is of the linear region alone. */
static double saturating_of(const struct dalcs_parameter *p, const struct dalcs_token *type) {
    const bool is_vdmos = strcmp(type->text, "vdmos") == 0;
    return is_igbt(type) ? 0 : gain_of(p, type) / (is_vdmos ? p[MTRIODE].value : 1);
}

static void set_diode(struct dalcs_transistor *t, const struct dalcs_parameter *p) {
    const bool is_of_igbt = t->kind == DALCS_IGBT;
    t->drop = p[VDIODE].value;
    t->has_diode =
        is_of_igbt ? p[VDIODE].place != NULL || p[RDIODE].place != NULL : p[IS].value > 0;
    t->diode = (struct dalcs_diode_card){.ilimit = (double)INFINITY,
                                         .revilimit = (double)INFINITY,
                                         .saturation = p[IS].value,
                                         .emission = p[N].value,
                                         .resistance = p[is_of_igbt ? RDIODE : RB].value,
                                         .breakdown = p[BV].value,
                                         .breakdown_current = 1};
}

/* What a model has where it says nothing. */
static void set_defaults(struct dalcs_parameter p[N_PARAMETERS], const struct dalcs_token *type) {
    const bool igbt = is_igbt(type);
    const bool vdmos = strcmp(type->text, "vdmos") == 0;
    const struct dalcs_parameter own[N_PARAMETERS] = {
        [VTO] = {igbt ? "vt" : "vto", DALCS_VOLTAGE, false, igbt ? 4.7 : 0, NULL},
        [KP] = {"kp", DALCS_PLAIN, false,
                vdmos  ? 1
                : igbt ? 0.38
                       : 2e-5,
                NULL},
        [W] = {"w", DALCS_PLAIN, false, 1e-4, NULL},
        [L] = {"l", DALCS_PLAIN, false, 1e-4, NULL},
        [RD] = {"rd", DALCS_OHM, false, 0, NULL},
        [RS] = {"rs", DALCS_OHM, false, 0, NULL},
        [RDS] = {"rds", DALCS_OHM, true, (double)INFINITY, NULL},
        [RON] = {"ron", DALCS_OHM, false, 0, NULL},
        [VGON] = {"vgon", DALCS_VOLTAGE, false, 0, NULL},
        [IS] = {"is", DALCS_CURRENT, false, 1e-14, NULL},
        [N] = {"n", DALCS_PLAIN, false, 1, NULL},
        [RB] = {"rb", DALCS_OHM, false, 0, NULL},
        [BV] = {"bv", DALCS_VOLTAGE, true, (double)INFINITY, NULL},
        [MTRIODE] = {"mtriode", DALCS_PLAIN, false, 1, NULL},
        [LEVEL] = {"level", DALCS_PLAIN, false, 1, NULL},
        [TOX] = {"tox", DALCS_PLAIN, false, 1e-7, NULL},
        [UO] = {"uo", DALCS_PLAIN, false, 600, NULL},
        [VCE0] = {"vce0", DALCS_VOLTAGE, false, 0.8, NULL},
        [VDIODE] = {"vdiode", DALCS_VOLTAGE, false, 0, NULL},
        [RDIODE] = {"rdiode", DALCS_OHM, false, 0, NULL},
    };
    memcpy(p, own, sizeof own);
    if (is_bipolar(type)) {
        p[RD].name = "rc";
        p[RS].name = "re";
        p[IS].value = 1e-16;
    }
}

struct dalcs_transistor *dalcs_transistor_parse_model(struct dalcs_reader *reader,
                                                      const struct dalcs_token *name,
                                                      const struct dalcs_token *type) {
    struct dalcs_builder *builder = reader->builder;
    const bool igbt = is_igbt(type);
    const bool vdmos = strcmp(type->text, "vdmos") == 0;
    struct dalcs_parameter p[N_PARAMETERS];
    set_defaults(p, type);
    reader->usage = igbt ? IGBT_USAGE : is_bipolar(type) ? BIPOLAR_USAGE : MOSFET_USAGE;
    bool is_p = strcmp(type->text, "pmos") == 0 || strcmp(type->text, "pnp") == 0;
    if (!read_all(reader, p, &is_p) || !check(builder, p, reader->usage)) {
        return NULL;
    }
    struct dalcs_transistor *t = dalcs_arena_alloc(&builder->scratch, 1, sizeof *t);
    if (t == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *t = (struct dalcs_transistor){.kind = igbt               ? DALCS_IGBT
                                           : is_bipolar(type) ? DALCS_BIPOLAR
                                                              : DALCS_MOSFET,
                                   .name = name->text,
                                   .is_p = is_p,
                                   .is_lateral = !vdmos && !igbt && !is_bipolar(type),
                                   .threshold = p[VTO].value,
                                   .gain = gain_of(p, type),
                                   .saturating = saturating_of(p, type),
                                   .width = vdmos || igbt ? 1 : p[W].value,
                                   .length = vdmos || igbt ? 1 : p[L].value,
                                   .ron = p[RON].value,
                                   .series = p[RD].value + p[RS].value,
                                   .leakage = p[RDS].value,
                                   .high = p[VGON].value,
                                   .knee = p[VCE0].value};
    set_diode(t, p);
    return t;
}
