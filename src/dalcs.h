/* dalcs.h - the public interface of libdalcs.
 *
 * A session holds one netlist: read it, run it, ask for results. Nothing is global: two sessions
 * may live in two threads, one session belongs to one thread at a time. Every call that can fail
 * returns an enum dalcs_status; what a person should read about a failure is in the session's
 * messages.
 *
 * Units are SI throughout: seconds, volts, amperes, coulombs, webers.
 *
 * The calls are in the headers of libdalcs/ by their subjects, which this one includes in their order. */
#ifndef DALCS_H
#define DALCS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#pragma GCC visibility push(default) /* all else in the library is hidden */
#endif

/* The number of this interface, and of the library's file: libdalcs.so.1. It is raised when a program
 * that was built with an older header could not go on with a newer library. */
#define DALCS_ABI 1

/* 0 is success, > 0 a numerical failure that a smaller step may cure, < 0 is final. */
#define DALCS_STATUS_LIST(ENTRY)                                                                   \
    ENTRY(DALCS_OK, 0, "ok")                                                                       \
    ENTRY(DALCS_SINGULAR, 1, "singular matrix")                                                    \
    ENTRY(DALCS_NOT_CONVERGED, 2, "no certified solution of the one-step problem was found")       \
    ENTRY(DALCS_INFEASIBLE, 3, "the one-step problem has no solution")                             \
    ENTRY(DALCS_REFUTED, 4, "the audit finds a law broken")                                        \
    ENTRY(DALCS_E_NOMEM, -1, "out of memory")                                                      \
    ENTRY(DALCS_E_IO, -2, "input/output error")                                                    \
    ENTRY(DALCS_E_NETLIST, -3, "error in the netlist")                                             \
    ENTRY(DALCS_E_OPTION, -4, "invalid option")                                                    \
    ENTRY(DALCS_E_LIMIT, -5, "problem too large")                                                  \
    ENTRY(DALCS_E_CANCELLED, -6, "cancelled")                                                      \
    ENTRY(DALCS_E_INTERNAL, -7, "internal error")

enum dalcs_status {

#define DALCS_STATUS_ENUM(name, value, text) name = (value),
    DALCS_STATUS_LIST(DALCS_STATUS_ENUM)
#undef DALCS_STATUS_ENUM
};

#if defined(__GNUC__)
#define DALCS_MUST_CHECK __attribute__((warn_unused_result))
#else
#define DALCS_MUST_CHECK
#endif

/* A short English phrase for a status; never NULL, do not free it. */
const char *dalcs_status_text(enum dalcs_status status);

/* "0.1.0", never NULL, do not free it. */
const char *dalcs_version(void);

/* A number as SPICE writes it, "1u", "2.5meg", "10kOhm". DALCS_E_OPTION when text is something else
 * or has anything after it; *value is then unchanged. */
enum dalcs_status dalcs_parse_number(const char *text, double *value) DALCS_MUST_CHECK;

/* Each needs those above it, so they are not sorted. */
#include "libdalcs/reading.h"

#include "libdalcs/equations.h"

#include "libdalcs/running.h"

#include "libdalcs/exchange.h"

#include "libdalcs/script.h"

#include "libdalcs/results.h"

#include "libdalcs/report.h"

#include "libdalcs/check.h"

#include "libdalcs/table_audit.h"

#include "libdalcs/spice.h"

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#ifdef __cplusplus
}
#endif

#endif
