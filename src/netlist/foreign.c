/* foreign.c - names drawings and signs that are no SPICE.
 *
 * A drawing read as a netlist gives an error for each of its lines, and none says that it is one. */
#include "foreign.h"

#include <string.h>

/* How a drawing begins, and its second line where the first may be the title of a netlist. */
static const struct {
    const char *first, *second;
    struct dalcs_foreign is;
} DRAWINGS[] = {
    {"Version ",
     "SHEET ",
     {"LTspice",
      "in LTspice, View > SPICE Netlist writes a netlist; so does 'LTspice -netlist FILE'"}},
    {"<Qucs Schematic", NULL, {"Qucs", "Qucs-S writes a netlist by Simulation > Save netlist"}},
    {"(kicad_sch", NULL, {"KiCad", "KiCad writes a netlist by File > Export > Netlist, Spice"}},
    {"EESchema Schematic",
     NULL,
     {"KiCad", "KiCad writes a netlist by File > Export > Netlist, Spice"}},
    {"v {xschem ", NULL, {"xschem", "xschem writes a netlist by Netlist"}},
    {"v 20", "C ", {"gschem", "'lepton-netlist -g spice-sdb FILE' or gnetlist writes a netlist"}},
};

static int begins(const char *text, size_t length, const char *with) {
    return length >= strlen(with) && memcmp(text, with, strlen(with)) == 0;
}

const struct dalcs_foreign *dalcs_foreign_drawing(const char *text, size_t length) {
    const char *newline = length > 0 ? memchr(text, '\n', length) : NULL;
    const size_t second = newline != NULL ? (size_t)(newline - text) + 1 : length;
    for (size_t k = 0; k < sizeof DRAWINGS / sizeof DRAWINGS[0]; k++) {
        if (begins(text, length, DRAWINGS[k].first) &&
            (DRAWINGS[k].second == NULL ||
             begins(text + second, length - second, DRAWINGS[k].second))) {
            return &DRAWINGS[k].is;
        }
    }
    return NULL;
}

const char *dalcs_foreign_sign(const char *word, size_t length) {
    static const struct {
        const char *sign, *hint;
    } SIGNS[] = {
        {"\xE2\x80\x93", "a dash is no minus: write -"},
        {"\xE2\x80\x94", "a dash is no minus: write -"},
        {"\xE2\x88\x92", "this minus is that of printed text: write -"},
        {"\xE2\x80\x98", "this quotation mark is that of printed text: leave it out, or write '"},
        {"\xE2\x80\x99", "this quotation mark is that of printed text: leave it out, or write '"},
        {"\xE2\x80\x9C", "this quotation mark is that of printed text: leave it out, or write \""},
        {"\xE2\x80\x9D", "this quotation mark is that of printed text: leave it out, or write \""},
        {"\xC3\x97", "this sign is that of printed text: write *"},
        {"\xC2\xB7", "this sign is that of printed text: write *"},
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
