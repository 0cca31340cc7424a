/* decibels.h - a response as a Bode plot: magnitudes in dB over phases. */
#ifndef DALCS_DECIBELS_H
#define DALCS_DECIBELS_H

#include "waveforms.h"

/* group[0] = "db(v(out)),...", group[1] = "phase(v(out)),...": of the gain of the loop of this source, or of
 * that in the table, if there is one, else of the first signals of a table of complex values that are more than rounding; both NULL where none is. In the
 * arena. */
enum dalcs_status dalcs_decibels_choose(const struct dalcs_waveforms *waveforms, const char *loop,
                                        struct dalcs_arena *arena,
                                        const char *group[2]) DALCS_MUST_CHECK;

#endif
