#include "froth/froth_breadcrumbs.h"
#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothGetBreadcrumbs(FrothContext* context, uint32_t capacity, FrothBreadcrumb* breadcrumbs,
                                uint32_t* count) {
  return guard(context, __func__, [&](const char* call) {
    return count ? context->listBreadcrumbs(capacity, breadcrumbs, *count) : failNull(*context, call, "count");
  });
}
