/* diode_parts.c - a table of diodes.
 *
 * Typical values at 25 degrees to two digits, as datasheets of such parts have them, and the rated reverse voltage; of
 * families that differ in that alone one line each. They are the usual figures, checked against no single maker's sheet:
 * where the second digit matters, a card of one's own says what it is. Zeners have their nominal voltage, at the current
 * that the datasheets test it at. */
#include "diode_families.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* ---- Rectifiers, signal diodes, LEDs ------------------------------------------------------------- */

/* A family whose last digits choose the reverse voltage. */
struct line {
    const char *names; /* with blanks between */
    enum dalcs_junction junction;
    double i1, v1, i2, v2;
    double reverse; /* V */
};

static const struct line LINES[] = {
    {"1n4148 1n914 1n4448 1n4150 1n4151 1n4154 mmsd4148 mmbd4148 mmbd914 ll4148 ls4148 1n914a "
     "1n914b 1n916 1n3064",
     DALCS_JUNCTION_SILICON, 1e-3, 0.60, 0.1, 0.92, 100},
    {"bas16 bav99 bav70 bav74 baw56 baw62 bas316 bal74 bal99 bas19 bav19 1ss355 1ss133 1s1588 "
     "s1588 "
     "1ss400",
     DALCS_JUNCTION_SILICON, 1e-3, 0.62, 0.1, 0.95, 100},
    {"bas20 bav20", DALCS_JUNCTION_SILICON, 1e-3, 0.60, 0.1, 0.87, 200},
    {"bas21 bav21", DALCS_JUNCTION_SILICON, 1e-3, 0.60, 0.1, 0.87, 250},
    {"1n4001", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 50},
    {"1n4002", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 100},
    {"1n4003", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 200},
    {"1n4004", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 400},
    {"1n4005", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 600},
    {"1n4006", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 800},
    {"1n4007 s1m m7 mra4007 gf1m ss1m rl107", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 1000},
    {"s1a mra4001", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 50},
    {"s1b", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 100},
    {"s1d mra4003", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 200},
    {"s1g mra4004", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 400},
    {"s1j mra4005", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 600},
    {"s1k", DALCS_JUNCTION_SILICON, 0.01, 0.65, 1, 0.93, 800},
    {"1n5391 rl151", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1.5, 0.95, 50},
    {"1n5392", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1.5, 0.95, 100},
    {"1n5393", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1.5, 0.95, 200},
    {"1n5395", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1.5, 0.95, 400},
    {"1n5397", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1.5, 0.95, 600},
    {"1n5399", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1.5, 0.95, 1000},
    {"1n5400", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 50},
    {"1n5401", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 100},
    {"1n5402", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 200},
    {"1n5404", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 400},
    {"1n5406", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 600},
    {"1n5407", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 800},
    {"1n5408 s3m", DALCS_JUNCTION_SILICON, 0.1, 0.70, 3, 0.92, 1000},
    {"mr750", DALCS_JUNCTION_SILICON, 0.6, 0.75, 6, 0.95, 50},
    {"mr754", DALCS_JUNCTION_SILICON, 0.6, 0.75, 6, 0.95, 400},
    {"mr760", DALCS_JUNCTION_SILICON, 0.6, 0.75, 6, 0.95, 1000},
    {"1n4933 fr101", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 50},
    {"1n4934 fr102", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 100},
    {"1n4935 fr103", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 200},
    {"1n4936 fr104", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 400},
    {"1n4937 fr105", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 600},
    {"fr106", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 800},
    {"fr107 rs1m", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 0.98, 1000},
    {"uf4001 es1a", DALCS_JUNCTION_SILICON, 0.01, 0.62, 1, 0.90, 50},
    {"uf4002 es1b", DALCS_JUNCTION_SILICON, 0.01, 0.62, 1, 0.90, 100},
    {"uf4003 es1d", DALCS_JUNCTION_SILICON, 0.01, 0.62, 1, 0.90, 200},
    {"uf4004 es1g", DALCS_JUNCTION_SILICON, 0.01, 0.64, 1, 0.98, 400},
    {"uf4005 es1j us1j", DALCS_JUNCTION_SILICON, 0.01, 0.70, 1, 1.35, 600},
    {"uf4006 us1k", DALCS_JUNCTION_SILICON, 0.01, 0.70, 1, 1.35, 800},
    {"uf4007 us1m", DALCS_JUNCTION_SILICON, 0.01, 0.70, 1, 1.35, 1000},
    {"uf5400", DALCS_JUNCTION_SILICON, 0.1, 0.68, 3, 0.92, 50},
    {"uf5402", DALCS_JUNCTION_SILICON, 0.1, 0.68, 3, 0.92, 200},
    {"uf5404", DALCS_JUNCTION_SILICON, 0.1, 0.72, 3, 0.98, 400},
    {"uf5408", DALCS_JUNCTION_SILICON, 0.1, 0.90, 3, 1.45, 1000},
    {"mur105 murs105", DALCS_JUNCTION_SILICON, 0.01, 0.60, 1, 0.83, 50},
    {"mur110 murs110", DALCS_JUNCTION_SILICON, 0.01, 0.60, 1, 0.83, 100},
    {"mur120 murs120", DALCS_JUNCTION_SILICON, 0.01, 0.60, 1, 0.83, 200},
    {"mur140 murs140", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 1.05, 400},
    {"mur160 murs160", DALCS_JUNCTION_SILICON, 0.01, 0.66, 1, 1.05, 600},
    {"mur1100 mur1100e", DALCS_JUNCTION_SILICON, 0.01, 0.75, 1, 1.50, 1000},
    {"mur405 murs305", DALCS_JUNCTION_SILICON, 0.1, 0.65, 4, 0.85, 50},
    {"mur410 murs310", DALCS_JUNCTION_SILICON, 0.1, 0.65, 4, 0.85, 100},
    {"mur420 murs320", DALCS_JUNCTION_SILICON, 0.1, 0.65, 4, 0.85, 200},
    {"mur440 murs340", DALCS_JUNCTION_SILICON, 0.1, 0.74, 4, 1.12, 400},
    {"mur460 murs360", DALCS_JUNCTION_SILICON, 0.1, 0.74, 4, 1.12, 600},
    {"mur4100 mur4100e", DALCS_JUNCTION_SILICON, 0.1, 0.95, 4, 1.60, 1000},
    {"mur820", DALCS_JUNCTION_SILICON, 0.1, 0.62, 8, 0.88, 200},
    {"mur840", DALCS_JUNCTION_SILICON, 0.1, 0.70, 8, 1.15, 400},
    {"mur860 mur860g byv29-600 stth8r06", DALCS_JUNCTION_SILICON, 0.1, 0.75, 8, 1.30, 600},
    {"mur1520 byw51-200", DALCS_JUNCTION_SILICON, 0.1, 0.60, 15, 0.92, 200},
    {"mur1560", DALCS_JUNCTION_SILICON, 0.1, 0.70, 15, 1.25, 600},
    {"mur3060", DALCS_JUNCTION_SILICON, 1, 0.80, 15, 1.25, 600},
    {"rhrp1560 isl9r1560", DALCS_JUNCTION_SILICON, 0.1, 0.80, 15, 1.80, 600},
    {"1n5817 b5817 mbrs120 ss12 sr102", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.28, 1, 0.40, 20},
    {"1n5818 b5818 mbrs130 ss13 10bq030", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.29, 1, 0.43, 30},
    {"1n5819 b5819 mbrs140 ss14 10bq040 b140 dfls140 sr104 stps1l40", DALCS_JUNCTION_SCHOTTKY, 0.1,
     0.30, 1, 0.47, 40},
    {"10bq015", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.22, 1, 0.32, 15},
    {"mbrs160 ss16 b160 dfls160 10bq060 10mq060 10mq060n sb160 sr106", DALCS_JUNCTION_SCHOTTKY, 0.1,
     0.36, 1, 0.55, 60},
    {"mbrs1100 ss110 10bq100 b1100 dfls1100 sr110", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.48, 1, 0.72,
     100},
    {"1n5820 mbrs320 ss32 sr302", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.24, 3, 0.42, 20},
    {"1n5821 mbrs330 ss33", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.25, 3, 0.45, 30},
    {"1n5822 mbrs340 ss34 b340 30bq040 sr304", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.27, 3, 0.47, 40},
    {"mbrs360 ss36 b360 30bq060 sb360 mbr360 sr306", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.35, 3, 0.60,
     60},
    {"mbrs3100 ss310 30bq100 mbr3100 sb3100", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.45, 3, 0.74, 100},
    {"ss54 sb540 mbr540 b540c pds540 sk54", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.25, 5, 0.48, 40},
    {"b530c ss53", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.25, 5, 0.48, 30},
    {"ss56 sb560 pds560", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.34, 5, 0.60, 60},
    {"pds5100 sb5100 ss510", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.42, 5, 0.72, 100},
    {"mbr0520 mbr0520l mbr0520lt", DALCS_JUNCTION_SCHOTTKY, 0.01, 0.20, 0.5, 0.36, 20},
    {"mbr0530", DALCS_JUNCTION_SCHOTTKY, 0.01, 0.24, 0.5, 0.41, 30},
    {"mbr0540", DALCS_JUNCTION_SCHOTTKY, 0.01, 0.26, 0.5, 0.47, 40},
    {"mbr735", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.28, 7.5, 0.55, 35},
    {"mbr745 mbr750", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.28, 7.5, 0.55, 45},
    {"mbr760", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.36, 7.5, 0.68, 60},
    {"mbr1035", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.27, 10, 0.56, 35},
    {"mbr1045 mbr1645", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.27, 10, 0.56, 45},
    {"mbr1060", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.35, 10, 0.70, 60},
    {"mbr10100", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.42, 10, 0.76, 100},
    {"mbr1535ct", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.27, 7.5, 0.56, 35},
    {"mbr1545ct", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.27, 7.5, 0.56, 45},
    {"mbr2045ct mbr2045 mbrb2045ct", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.27, 10, 0.58, 45},
    {"mbr2060ct", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.35, 10, 0.70, 60},
    {"mbr20100ct mbr20100 v20100", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.42, 10, 0.75, 100},
    {"mbr20200ct", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.50, 10, 0.82, 200},
    {"mbrb2515l", DALCS_JUNCTION_SCHOTTKY, 1, 0.25, 25, 0.42, 15},
    {"mbrb2545ct mbr2545ct", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.26, 15, 0.60, 45},
    {"mbr3045 mbr3045pt mbr3045wt", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.25, 20, 0.60, 45},
    {"bat54 bat54a bat54c bat54s bat54ws bat54j", DALCS_JUNCTION_SCHOTTKY, 1e-3, 0.28, 0.1, 0.55,
     30},
    {"bat85 bat85s bat42 bat43", DALCS_JUNCTION_SCHOTTKY, 1e-3, 0.29, 0.1, 0.60, 30},
    {"bat41 bat46", DALCS_JUNCTION_SCHOTTKY, 1e-3, 0.30, 0.1, 0.65, 100},
    {"bas70 bas70-04 bas70-05 bas70-06 1n5711 1n6263", DALCS_JUNCTION_SCHOTTKY, 1e-3, 0.38, 15e-3,
     0.80, 70},
    {"bas40 bas40-04 bas40-05 bas40-06", DALCS_JUNCTION_SCHOTTKY, 1e-3, 0.33, 40e-3, 0.80, 40},
    {"cmdsh-3", DALCS_JUNCTION_SCHOTTKY, 0.01, 0.33, 0.1, 0.50, 30},
    {"cmdsh2-3", DALCS_JUNCTION_SCHOTTKY, 0.01, 0.31, 0.2, 0.48, 30},
    {"rb218t150nz", DALCS_JUNCTION_SCHOTTKY, 1, 0.62, 10, 0.80, 150},
    {"upsc600", DALCS_JUNCTION_SCHOTTKY, 0.1, 0.95, 1, 1.50, 600},
    {"rfn60ts6d", DALCS_JUNCTION_SILICON, 3, 0.90, 30, 1.30, 600},
    {"rr1lam6s", DALCS_JUNCTION_SILICON, 0.1, 0.78, 1, 0.93, 600},
    {"rr2l6s", DALCS_JUNCTION_SILICON, 0.2, 0.80, 2, 0.95, 600},
    {"1n34 1n34a 1n60 1n270 aa112 aa119 oa90 oa91", DALCS_JUNCTION_GERMANIUM, 1e-4, 0.16, 5e-3,
     0.75, 60},
    {"led led_red red_led ledred red", DALCS_JUNCTION_LED, 1e-3, 1.60, 20e-3, 1.90, 5},
    {"led_orange led_yellow yellow_led ledyellow amber_led led_amber", DALCS_JUNCTION_LED, 1e-3,
     1.75, 20e-3, 2.05, 5},
    {"led_green green_led ledgreen qtlp600c", DALCS_JUNCTION_LED, 1e-3, 1.80, 20e-3, 2.15, 5},
    {"led_blue blue_led ledblue led_white white_led ledwhite nspw500bs nscw100", DALCS_JUNCTION_LED,
     1e-3, 2.70, 20e-3, 3.20, 5},
    {"led_ir ir_led ledir", DALCS_JUNCTION_LED, 1e-3, 1.05, 20e-3, 1.25, 5},
    {"qtlp690c qtlp690", DALCS_JUNCTION_LED, 1e-3, 1.60, 20e-3, 1.90, 5},
};

static bool names(const char *list, const char *name, size_t n) {
    while (*list != '\0') {
        const size_t length = strcspn(list, " ");
        if (length == n && strncmp(list, name, n) == 0) {
            return true;
        }
        list += length + strspn(list + length, " ");
    }
    return false;
}

static bool find_line(const char *name, size_t n, struct dalcs_diode_part *part) {
    for (size_t k = 0; k < sizeof LINES / sizeof LINES[0]; k++) {
        const struct line *line = &LINES[k];
        if (names(line->names, name, n)) {
            *part = (struct dalcs_diode_part){
                line->junction, {line->i1, line->i2}, {line->v1, line->v2}, line->reverse, 1e-4};
            return true;
        }
    }
    return false;
}

/* ---- Zeners ------------------------------------------------------------------------------------------ */

/* Numbered parts: first, first + 1, ... in the order of their voltages. */
struct series {
    const char *prefix;
    int first, n;
    const double *volts;
    double power;   /* W that is dissipated at the test current, */
    double current; /* which is at most this, A */
};

static const double E24[] = {3.3, 3.6, 3.9, 4.3, 4.7, 5.1, 5.6, 6.2, 6.8, 7.5, 8.2, 9.1, 10,
                             11,  12,  13,  15,  16,  18,  20,  22,  24,  27,  30,  33,  36,
                             39,  43,  47,  51,  56,  62,  68,  75,  82,  91,  100};
static const double HALF_WATT[] = {2.4, 2.5, 2.7, 2.8, 3.0, 3.3, 3.6, 3.9, 4.3, 4.7, 5.1, 5.6, 6.0,
                                   6.2, 6.8, 7.5, 8.2, 8.7, 9.1, 10,  11,  12,  13,  14,  15,  16,
                                   17,  18,  19,  20,  22,  24,  25,  27,  28,  30,  33,  36,  39,
                                   43,  47,  51,  56,  60,  62,  68,  75,  82,  87,  91,  100};
static const double OLD[] = {3.3, 3.6, 3.9, 4.3, 4.7, 5.1, 5.6, 6.2, 6.8, 7.5, 8.2, 9.1, 10, 12};
static const double OLDER[] = {6.8, 7.5, 8.2, 9.1, 10, 11, 12, 13, 15,
                               16,  18,  20,  22,  24, 27, 30, 33};
static const double FIVE_WATTS[] = {3.3, 3.6, 3.9, 4.3, 4.7, 5.1, 5.6, 6.0, 6.2, 6.8, 7.5, 8.2,
                                    8.7, 9.1, 10,  11,  12,  13,  14,  15,  16,  17,  18,  19,
                                    20,  22,  24,  25,  27,  28,  30,  33,  36,  39,  43,  47,
                                    51,  56,  60,  62,  68,  75,  82,  87,  91,  100};

#define SERIES(prefix, first, volts, power, current)                                               \
    { prefix, first, (int)(sizeof(volts) / sizeof(volts)[0]), volts, power, current }

static const struct series SERIES[] = {
    SERIES("1n", 4728, E24, 0.25, 1),
    SERIES("1n", 5221, HALF_WATT, 0.125, 20e-3),
    SERIES("mmsz", 5221, HALF_WATT, 0.125, 20e-3),
    SERIES("mmbz", 5221, HALF_WATT, 0.125, 20e-3),
    SERIES("1n", 746, OLD, 1, 20e-3),
    SERIES("1n", 957, OLDER, 0.125, 1),
    SERIES("1n", 5333, FIVE_WATTS, 1.25, 1),
};

static void set_zener(double volts, double current, struct dalcs_diode_part *part) {
    *part =
        (struct dalcs_diode_part){DALCS_JUNCTION_ZENER, {1e-3, 0.1}, {0.65, 0.90}, volts, current};
}

static bool find_numbered(const char *name, size_t n, struct dalcs_diode_part *part) {
    for (size_t k = 0; k < sizeof SERIES / sizeof SERIES[0]; k++) {
        const struct series *s = &SERIES[k];
        const size_t prefix = strlen(s->prefix);
        if (n <= prefix || strncmp(name, s->prefix, prefix) != 0) {
            continue;
        }
        char *end;
        const long number = strtol(name + prefix, &end, 10);
        const bool is_all = (size_t)(end - name) == n;
        if (is_all && number >= s->first && number < s->first + s->n) {
            const double volts = s->volts[number - s->first];
            const double current = s->power / volts;
            set_zener(volts, current < s->current ? current : s->current, part);
            return true;
        }
    }
    return false;
}

/* BZX84C6V2, BZX79-C15: the voltage is in the name. */
static bool find_named(const char *name, size_t n, struct dalcs_diode_part *part) {
    static const struct {
        const char *prefix;
        double power, current; /* as above */
    } families[] = {{"bzx84", 0.12, 5e-3},  {"bzx79", 0.12, 5e-3},  {"bzx55", 0.12, 5e-3},
                    {"bzx384", 0.12, 5e-3}, {"bzx585", 0.12, 5e-3}, {"bzv55", 0.12, 5e-3},
                    {"bzt52", 0.12, 5e-3},  {"bzx85", 0.35, 1},     {"bzv85", 0.35, 1},
                    {"bzg03", 0.5, 1},      {"mm3z", 0.12, 5e-3},   {"udzv", 0.12, 5e-3},
                    {"ufzv", 0.12, 5e-3},   {"dflz", 0.35, 1},      {"p4ke", 1, 10e-3},
                    {"p6ke", 1, 10e-3},     {"1.5ke", 1, 10e-3}};

    for (size_t k = 0; k < sizeof families / sizeof families[0]; k++) {
        const size_t prefix = strlen(families[k].prefix);
        if (n < prefix || strncmp(name, families[k].prefix, prefix) != 0) {
            continue;
        }
        const char *p = name + prefix;
        p += *p == '-';
        p += *p == 'b' || *p == 'c'; /* 2 % or 5 % */
        char *end;
        double volts = (double)strtol(p, &end, 10);
        if (end == p) {
            return false;
        }
        if (*end == 'v' && end[1] >= '0' && end[1] <= '9') {
            volts += 0.1 * (end[1] - '0');
            end += 2;
        }
        const double current = volts > 0 ? families[k].power / volts : 0;
        if ((size_t)(end - name) == n && volts >= 1.8 && volts <= 600) {
            set_zener(volts, current < families[k].current ? current : families[k].current, part);
            return true;
        }
    }
    return false;
}

/* ---- Names ------------------------------------------------------------------------------------------- */

static bool find(const char *name, size_t n, struct dalcs_diode_part *part) {
    return find_line(name, n, part) || find_numbered(name, n, part) || find_named(name, n, part) ||
           dalcs_diode_family_find(name, n, part);
}

bool dalcs_diode_part_find(const char *name, struct dalcs_diode_part *part) {
    /* Of PSpice's and of a maker's libraries; and suffixes for housings and tapes. */
    static const char *const prefixes[] = {"", "d", "di_", "d_", "diode_"};
    static const char *const suffixes[] = {
        "",     "a",     "b",   "w",   "ws",   "wt",    "g",  "l",   "rl",  "rlg",
        "t1",   "t1g",   "t3g", "lt1", "lt1g", "lt3g",  "-t", "tr",  "-tp", "s",
        "-7-f", "-13-f", "bg",  "-e3", "_f",   "w-7-f", "vl", "vly", "ly",  "wj",
        "ct",   "wt",    "pt",  "g2",  "d1",   "e",     "c",  "t"};
    const size_t n = strlen(name);
    for (size_t k = 0; k < sizeof prefixes / sizeof prefixes[0]; k++) {
        const size_t before = strlen(prefixes[k]);
        if (n <= before || strncmp(name, prefixes[k], before) != 0) {
            continue;
        }
        for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++) {
            const size_t behind = strlen(suffixes[i]);
            if (n > before + behind && strcmp(name + n - behind, suffixes[i]) == 0 &&
                find(name + before, n - before - behind, part)) {
                return true;
            }
        }
    }
    return false;
}

const char *dalcs_junction_text(enum dalcs_junction junction) {
    static const char *const text[] = {[DALCS_JUNCTION_SILICON] = "a silicon diode",
                                       [DALCS_JUNCTION_SCHOTTKY] = "a Schottky diode",
                                       [DALCS_JUNCTION_GERMANIUM] = "a germanium diode",
                                       [DALCS_JUNCTION_LED] = "an LED",
                                       [DALCS_JUNCTION_ZENER] = "a Zener diode"};
    return text[junction];
}

/* The steepest straight line that the curves of such junctions have over a decade of small currents, in kT/q. */
double dalcs_junction_emission(enum dalcs_junction junction) {
    static const double emission[] = {[DALCS_JUNCTION_SILICON] = 1.8,
                                      [DALCS_JUNCTION_SCHOTTKY] = 1.05,
                                      [DALCS_JUNCTION_GERMANIUM] = 1.3,
                                      [DALCS_JUNCTION_LED] = 2.0,
                                      [DALCS_JUNCTION_ZENER] = 1.5};
    return emission[junction];
}
