#ifndef ETALON_LIVE_TEV_H
#define ETALON_LIVE_TEV_H

/* Packets of the protocol by which renderers show pictures in tev (github.com/Tom94/tev,
 * README, "Over the network"; src/Ipc.cpp) and in pbrt v4's display servers
 * (src/pbrt/util/display.cpp). All numbers are little-endian:
 *
 *   uint32 length of the packet with these four bytes; uint8 kind; then
 *   CreateImage (4): uint8 grab focus, name\0, int32 width, int32 height,
 *                    int32 number of channels, channel\0 ...
 *   UpdateImage (3): uint8 grab focus, name\0, channel\0, int32 x, y, width, height of a
 *                    tile, float32 values [height][width]
 */

#include "image/image.h"

#include <stdint.h>

#define TEV_TILE 128 /* pixels, largest width and height of a tile, as pbrt's */

/* Bytes that suffice for any packet of a picture of that name. */
size_t tev_packet_most(const char *name);
/* Write a packet to `to`, and return its length. */
size_t tev_create_image(uint8_t *to, const char *name, int width, int height);
/* The values of one channel, 0 to 2 (R, G, B), in the tile whose corner is x, y. */
size_t tev_update_image(uint8_t *to, const char *name, const struct image *image,
                        int channel, int x, int y);

#endif
