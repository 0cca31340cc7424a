/* foreign.c - names files and signs that are no SPICE.
 *
 * A drawing read as a netlist gives an error for each of its lines, and none says that it is
 * one. */
#include "foreign.h"

#include <string.h>

#define KICAD  "KiCad writes a netlist by File > Export > Netlist, Spice"
#define SYSTEM "a system file begins with: dalcs-system 2 TITLE"

/* The kind of a file, and how to make a netlist of it or run it. */
struct kind {
    const char *what, *hint;
};

/* How a file begins, and its second line where the first may be the title of a netlist. */
static const struct {
    const char *first, *second;
    struct kind is;
} FILES[] = {
    {"Version ",
     "SHEET ",
     {"a drawing of LTspice",
      "in LTspice, View > SPICE Netlist writes a netlist; so does 'LTspice -netlist FILE'"}},
    {"<Qucs Schematic",
     NULL,
     {"a drawing of Qucs", "Qucs-S writes a netlist by Simulation > Save netlist"}},
    {"(kicad_sch", NULL, {"a drawing of KiCad", KICAD}},
    {"EESchema Schematic", NULL, {"a drawing of KiCad", KICAD}},
    {"v {xschem ", NULL, {"a drawing of xschem", "xschem writes a netlist by Netlist"}},
    {"v 20",
     "C ",
     {"a drawing of gschem", "'lepton-netlist -g spice-sdb FILE' or gnetlist writes a netlist"}},
    {"dalcs-system 1",
     "about ",
     {"a one-step problem that could not be solved",
      "'tools/replay FILE' solves it again and says where it fails"}},
    {"Title: ",
     "Date: ",
     {"a raw file of waveforms",
      "'dalcs plot FILE' draws it, 'dalcs audit NETLIST FILE' checks it"}},
    {"dalcs-system", NULL, {"a system file of another version", SYSTEM}},
};

static bool begins(const char *text, size_t length, const char *with) {
    return length >= strlen(with) && memcmp(text, with, strlen(with)) == 0;
}

/* NULL: a netlist, as far as is known. */
static const struct kind *kind_of(const char *name, const char *text, size_t length) {
    static const struct kind headless = {"a system file without its first line", SYSTEM};
    if (begins(text, length, "\xEF\xBB\xBF")) { /* a byte order mark */
        text += 3;
        length -= 3;
    }
    if (begins(text, length, "dalcs-system 2")) {
        return NULL; /* its cards are read like those of a netlist */
    }
    const char *newline = length > 0 ? memchr(text, '\n', length) : NULL;
    const size_t second = newline != NULL ? (size_t)(newline - text) + 1 : length;
    for (size_t k = 0; k < sizeof FILES / sizeof FILES[0]; k++) {
        if (begins(text, length, FILES[k].first) &&
            (FILES[k].second == NULL || begins(text + second, length - second, FILES[k].second))) {
            return &FILES[k].is;
        }
    }
    const char *dot = strrchr(name, '.');
    return dot != NULL && strcmp(dot, ".dalcs") == 0 ? &headless : NULL;
}

bool dalcs_foreign_is_reported(struct dalcs_netlist *netlist, const struct dalcs_source *source,
                               const char *text, size_t length, struct dalcs_diag *diag) {
    const struct kind *file = kind_of(source->name, text, length);
    if (file == NULL) {
        return false;
    }
    const struct dalcs_location where = {.file = source->name,
                                         .line = 1,
                                         .column = 1,
                                         .length = 1,
                                         .file_number = source->number,
                                         .included = source->included};
    dalcs_diag_add(diag, DALCS_ERROR, &where, file->hint, "this is %s, not a netlist", file->what);
    netlist->has_errors = true;
    return true;
}

const char *dalcs_foreign_sign(const char *word, size_t length) {
    static const struct {
        const char *sign, *hint;
    } SIGNS[] = {
        {"\xE2\x80\x93", "this dash is not a minus sign: write -"},
        {"\xE2\x80\x94", "this dash is not a minus sign: write -"},
        {"\xE2\x88\x92", "this is a typographic minus sign: write -"},
        {"\xE2\x80\x98", "this is a typographic quotation mark: leave it out, or write '"},
        {"\xE2\x80\x99", "this is a typographic quotation mark: leave it out, or write '"},
        {"\xE2\x80\x9C", "this is a typographic quotation mark: leave it out, or write \""},
        {"\xE2\x80\x9D", "this is a typographic quotation mark: leave it out, or write \""},
        {"\xC3\x97", "this is a typographic sign: write *"},
        {"\xC2\xB7", "this is a typographic sign: write *"},
    };

    for (size_t at = 0; at < length; at++) {
        for (size_t k = 0; k < sizeof SIGNS / sizeof SIGNS[0]; k++) {
            if (begins(word + at, length - at, SIGNS[k].sign)) {
                return SIGNS[k].hint;
            }
        }
    }
    return length > 0 && word[0] == '#' ? "a comment behind a card begins with ';'" : NULL;
}
