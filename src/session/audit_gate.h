/* audit_gate.h - one gate as the audit knows it. Private to this folder. */
#ifndef DALCS_AUDIT_GATE_H
#define DALCS_AUDIT_GATE_H

#include "audit_gates.h"

/* More inputs share the last bit: of these only gates without memory have so many. */
enum { AUDIT_GATE_BITS = 32 };

struct audit_gate {
    bool q;                  /* decided */
    bool clock, data, reset; /* when it was looked at last; reset: or what else forces it */
    bool is_lost;            /* behind a delay something depended on an order within an instant */
    bool shown;              /* what it has to show by now */
    int count;               /* of clocks; -1: it is not known */
    double held;             /* V, by a sample */
    bool was_seen;
    bool rests;  /* no time changes what was found of it: only what it reads or shows does */
    bool showed; /* when it was looked at last */
    int n_sources;
    const int *source; /* [n_sources] places of what it reads, in `says` */
    unsigned read;     /* when it was looked at last: a bit for each of them */
    unsigned flashes;  /* its inputs that were on another side for no time */
    double free_at;    /* s: what was decided when it was lost is shown from then on */
    double before;     /* V, what it may take at this instant */
    double ends;       /* s: a pulse, or the time behind it in which no clock counts */
    double *due;       /* [n_due] s: what it has to show changes */
    size_t first_due, n_due, capacity;
};

/* What the inputs say; held: they leave it as it was, as far as can be told. */
struct audit_verdict {
    bool q, is_held, is_known, is_forced;
};

/* Of all gates; `gate` is there. */
enum dalcs_status audit_gates_list_sources(struct dalcs_audit_gates *a) DALCS_MUST_CHECK;

/* What all gates show and all comparators say now: anything else than before? */
bool audit_gates_read(struct dalcs_audit_gates *a);

/* Does gate k read or show anything else than when it was looked at last? Notes what it does now. */
bool audit_gate_reads_another(const struct dalcs_audit_gates *a, int k);

/* The stimulus of its pin; -1: it has none. */
int audit_gate_shown_by(const struct dalcs_logic_gate *g);

/* Do its pins show one bit, at its levels, and went there in the time that its ramps take? */
bool audit_gate_is_written(const struct dalcs_audit_gates *a, int k);

/* *is_known: not what a gate says that nothing shows. */
bool audit_gate_reads(const struct dalcs_audit_gates *a, const struct dalcs_logic_input *input,
                      bool *is_known);

/* What ends a pulse of a comparator may be what it did: a latch that opens a switch at a current is reset for no time, as the
 * current falls from there on. The run tells which comparators came back; that they could have gone is found here: what
 * they read was where it changes over. A bit for each input. */
unsigned audit_gate_flashes(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                            struct dalcs_audit *audit, double t);

/* Of a gate without memory, by its inputs. */
struct audit_verdict audit_gate_of_inputs(const struct dalcs_audit_gates *a,
                                          const struct dalcs_logic_gate *g);

/* Of a latch or a flip-flop. */
struct audit_verdict audit_gate_of_memory(const struct dalcs_audit_gates *a,
                                          const struct dalcs_logic_gate *g, struct audit_gate *s);

/* After a lost count, q that rises with the clock is the first of a cycle. */
struct audit_verdict audit_gate_of_counter(const struct dalcs_audit_gates *a,
                                           const struct dalcs_logic_gate *g, struct audit_gate *s,
                                           bool now);

/* The pulse that a clock began lasts as long as what was read just before that says. */
struct audit_verdict audit_gate_of_monostable(const struct dalcs_audit_gates *a,
                                              const struct dalcs_logic_gate *g,
                                              struct audit_gate *s, double t);

/* May one have set it? */
bool audit_gate_may_have_missed(const struct dalcs_audit_gates *a,
                                const struct dalcs_logic_gate *g);

/* May one have undone what the clock of a flip-flop has just made of it? So it is in a phase detector, whose flip-flops
 * clear each other. */
bool audit_gate_may_be_undone(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                              const struct audit_verdict *v);

/* It has decided q: from `due` on it has to show that. */
enum dalcs_status audit_gate_expect(struct audit_gate *s, bool q, double due);

#endif
