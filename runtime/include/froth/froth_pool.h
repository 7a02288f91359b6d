/* Froth, a pool of threads for its jobs, for applications without a scheduler of their own. Link froth::pool.
 *
 *   frothCreateJobPool(0, &pool);
 *   FrothContextInfo info = {..., .runJob = frothRunInPool, .jobUser = pool};
 */
#ifndef FROTH_FROTH_POOL_H
#define FROTH_FROTH_POOL_H

#include "froth/froth_context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct FrothJobPool FrothJobPool;

/* threads [<= 64]: 0: 2. FROTH_ERROR_ARGUMENT: more, or pool is null. FROTH_ERROR_MEMORY: no thread can be made. *pool
 * is null on an error. */
FrothResult frothCreateJobPool(uint32_t threads, FrothJobPool** pool);

/* Returns when all jobs have ended. Destroy its contexts first: jobs that have not begun then do nothing. A null
 * pointer does nothing. */
void frothDestroyJobPool(FrothJobPool* pool);

/* A FrothRunJob; `pool` is the FrothJobPool. Jobs begin in the order of the calls. */
void frothRunInPool(void* pool, FrothJob job, void* argument);

#ifdef __cplusplus
}
#endif
#endif
