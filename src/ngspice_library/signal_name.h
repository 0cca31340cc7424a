/* signal_name.h - the names of one signal: "v(out)" here, "out" in ngspice; "i(v1)" and "v1#branch"; "i(d1)" and
 * "@d1[id]". */
#ifndef DALCS_NG_SIGNAL_NAME_H
#define DALCS_NG_SIGNAL_NAME_H

#include <stddef.h>

enum { NG_NAME_SIZE = 256 };

/* As ngspice calls the signal of dalcs. */
void ng_signal_name(const char *signal, char name[NG_NAME_SIZE]);

/* The signal that a program may mean by a name, which has it in one of ngspice's spellings, in any case. */
void ng_signal_of(const char *name, char signal[NG_NAME_SIZE]);

#endif
