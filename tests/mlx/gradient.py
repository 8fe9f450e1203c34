"""A complete MiniLibX program: a gradient in a window; Escape or the close button ends it."""

from minirt.mlx import Event, Key, Mlx

m = Mlx()
mlx = m.mlx_init()
win = m.mlx_new_window(mlx, 512, 256, "gradient")
image = m.mlx_new_image(mlx, 512, 256)
data, bits, line, _ = m.mlx_get_data_addr(image)
for y in range(256):
    for x in range(512):
        at = y * line + x * bits // 8
        data[at : at + 4] = bytes((64, y, x // 2, 255))  # blue, green, red, alpha
m.mlx_put_image_to_window(mlx, win, image, 0, 0)
m.mlx_key_hook(win, lambda key, _: m.mlx_loop_exit(mlx) if key == Key.ESCAPE else None, None)
m.mlx_hook(win, Event.DESTROY_NOTIFY, 0, lambda _: m.mlx_loop_exit(mlx), None)
m.mlx_loop(mlx)
