/* A device in C: depth frames in, poses out.   locate ID DOMAIN WIDTH HEIGHT FOCAL_PX < FRAMES
   Standard input stands for your camera's driver: of each frame a stamp (int64, ns), then its depths (uint16,
   mm). */
#include <liloc/client.h>
#include <stdio.h>
#include <stdlib.h>

static const char* const kStates[] = {"searching", "tracking", "coasting", "lost"};

static void print(const liloc_pose_update* now, void* user) { /* on the registration's thread */
  const double* t = now->T_map_sensor.translation_m;
  (void)user;
  printf("%lld %s", (long long)now->stamp_ns, kStates[now->state]);
  if (now->has_map) printf(" %.3f %.3f %.3f", t[0], t[1], t[2]);
  printf("\n");
}

int main(int argc, char** argv) {
  liloc_client_options options;
  liloc_client* client = NULL;
  int64_t stamp_ns = 0;
  if (argc != 6) return 2;
  const int width = atoi(argv[3]), height = atoi(argv[4]);
  const double focal_px = atof(argv[5]);
  liloc_client_options_init(&options, sizeof options);
  options.id = argv[1];
  options.domain = atoi(argv[2]);
  options.camera =
      (liloc_camera){width, height, focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0, 0.001};

  if (liloc_client_create(&options, sizeof options, &client) || liloc_client_on_pose(client, print, NULL) ||
      liloc_client_start(client)) {
    fprintf(stderr, "%s\n", liloc_client_last_error());
    return 1;
  }
  const size_t pixels = (size_t)width * (size_t)height;
  uint16_t* depth_mm = malloc(pixels * sizeof *depth_mm);
  if (depth_mm == NULL) return 1;
  while (fread(&stamp_ns, sizeof stamp_ns, 1, stdin) == 1 &&
         fread(depth_mm, sizeof *depth_mm, pixels, stdin) == pixels)
    if (liloc_client_push_depth(client, depth_mm, width, height, stamp_ns))
      fprintf(stderr, "%s\n", liloc_client_last_error());
  liloc_client_stop(client);
  liloc_client_destroy(client);
  free(depth_mm);
  return 0;
}
