/* dialect.h - for which simulator a netlist was written.
 *
 * Where dialects differ, dalcs reads a netlist as ngspice would, unless it is told or shown another one.
 * What is told holds without a word; of what is only shown, a note says so, and where it changes a value
 * a warning does. */
#ifndef DALCS_DIALECT_H
#define DALCS_DIALECT_H

#include "status.h"

/* In the order of dalcs_dialect_name, after the first. */
enum dalcs_dialect_name {
    DALCS_DIALECT_UNKNOWN, /* as ngspice, with warnings of what others would make of it */
    DALCS_DIALECT_NGSPICE,
    DALCS_DIALECT_LTSPICE,
    DALCS_DIALECT_XYCE
};

struct dalcs_dialect {
    enum dalcs_dialect_name name;
    bool is_told; /* by .options dialect= or by who reads the netlist, not shown by a sign */
};

static inline bool dalcs_dialect_is_told(struct dalcs_dialect dialect,
                                         enum dalcs_dialect_name name) {
    return dialect.is_told && dialect.name == name;
}

/* As people write it. */
static inline const char *dalcs_dialect_simulator(enum dalcs_dialect_name name) {
    return name == DALCS_DIALECT_LTSPICE ? "LTspice"
           : name == DALCS_DIALECT_XYCE  ? "Xyce"
                                         : "ngspice";
}

/* A hint: their names. */
extern const char DALCS_DIALECTS[];

/* The dialect of this name; false, nothing changed, when there is none. */
bool dalcs_dialect_find(const char *text, enum dalcs_dialect_name *name);

struct dalcs_diag;
struct dalcs_netlist;

/* Settles the dialect of a netlist that was read, unless it was told before: by .options dialect=, else
 * by what only one simulator understands. */
void dalcs_dialect_settle(struct dalcs_netlist *netlist, struct dalcs_diag *diag);

#endif
