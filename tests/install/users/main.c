/* A C11 program without a device: asks, creates, opens a file that does not exist, and gets a message. */
#include <froth/froth_estimate.h>
#include <froth/froth_query.h>
#include <froth/froth_walk.h>
#include <stdio.h>

static void print_message(void* user, FrothSeverity severity, FrothResult code, const char* object, const char* text) {
  (void)severity;
  ++*(int*)user;
  printf("%s: %s: %s\n", frothResultName(code), object, text);
}

int main(void) {
  FrothRequirements requirements = {.structSize = sizeof requirements};
  if (frothGetRequirements(NULL, NULL, NULL, &requirements) != FROTH_OK) return 1;
  for (uint32_t i = 0; i < requirements.itemCount; ++i) printf("needs %s\n", requirements.items[i].name);

  int messages = 0;
  FrothContextInfo contextInfo = {.structSize = sizeof contextInfo,
                                  .abiVersion = FROTH_ABI_VERSION,
                                  .onMessage = print_message,
                                  .messageUser = &messages};
  FrothContext* context = NULL;
  if (frothCreateContext(&contextInfo, &context) != FROTH_OK) return 2;
  FrothAssetInfo assetInfo = {.structSize = sizeof assetInfo, .path = "missing.froth"};
  FrothAsset asset;
  if (frothOpenAsset(context, &assetInfo, &asset) != FROTH_OK) return 3;
  FrothFrame frame = {.structSize = sizeof frame, .serial = 1};
  if (frothUpdate(context, &frame, NULL) != FROTH_OK) return 4;
  FrothAssetStatus status = {.structSize = sizeof status};
  if (frothGetAssetStatus(context, asset, &status) != FROTH_OK || status.state != FROTH_ASSET_FAILED) return 5;
  frothDestroyContext(context, UINT64_MAX);
  return messages == 1 ? 0 : 6;
}
