/* session.c - the whole flow behind dalcs.h. */
#include "dalcs.h"
