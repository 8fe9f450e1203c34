/*
** A MiniLibX without a screen: what a program draws into its window is written to a picture.
**
** Build your program with this file in place of the library, and run it:
**
**     cc -o mini *.c mlx_stub.c -lm
**     MLX_PICTURE=mine.ppm ./mini scene.rt
**
** Windows and images are arrays of pixels (blue, green, red, unused). mlx_loop calls the loop hook MLX_FRAMES times
** (3 without), writes the window to MLX_PICTURE (window.ppm without) and ends the program. Keys and buttons are never
** pressed.
*/

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct s_pixels
{
	int				width;
	int				height;
	unsigned char	*data;
}	t_pixels;

typedef int	(*t_hook)(void *);

static t_pixels	*g_window;
static t_hook	g_loop_hook;
static t_hook	g_expose_hook;
static void		*g_loop_data;
static void		*g_expose_data;

static t_pixels	*new_pixels(int width, int height)
{
	t_pixels	*pixels;

	pixels = calloc(1, sizeof(*pixels));
	if (!pixels || width < 1 || height < 1)
		return (NULL);
	pixels->width = width;
	pixels->height = height;
	pixels->data = calloc((size_t)width * height, 4);
	if (!pixels->data)
		return (NULL);
	return (pixels);
}

static void	copy_pixel(t_pixels *into, int x, int y, const void *pixel)
{
	if (into && x >= 0 && y >= 0 && x < into->width && y < into->height)
		memcpy(into->data + 4 * ((size_t)y * into->width + x), pixel, 4);
}

static void	write_window(void)
{
	const char	*name;
	FILE		*file;
	size_t		i;

	name = getenv("MLX_PICTURE");
	if (!name)
		name = "window.ppm";
	file = fopen(name, "wb");
	if (!g_window || !file)
	{
		fprintf(stderr, "mlx_stub: no window, or %s cannot be written\n", name);
		exit(1);
	}
	fprintf(file, "P6\n%d %d\n255\n", g_window->width, g_window->height);
	i = 0;
	while (i < (size_t)g_window->width * g_window->height)
	{
		fputc(g_window->data[4 * i + 2], file);
		fputc(g_window->data[4 * i + 1], file);
		fputc(g_window->data[4 * i], file);
		i++;
	}
	fclose(file);
	exit(0);
}

void	*mlx_init(void)
{
	return (calloc(1, 4096));
}

void	*mlx_new_window(void *mlx, int width, int height, char *title)
{
	(void)mlx;
	(void)title;
	g_window = new_pixels(width, height);
	return (g_window);
}

void	*mlx_new_image(void *mlx, int width, int height)
{
	(void)mlx;
	return (new_pixels(width, height));
}

char	*mlx_get_data_addr(void *image, int *bits, int *line, int *endian)
{
	*bits = 32;
	*line = 4 * ((t_pixels *)image)->width;
	*endian = 0;
	return ((char *)((t_pixels *)image)->data);
}

int	mlx_put_image_to_window(void *mlx, void *window, void *image, int x, int y)
{
	t_pixels	*from;
	int			i;

	(void)mlx;
	from = image;
	i = 0;
	while (from && i < from->width * from->height)
	{
		copy_pixel(window, x + i % from->width, y + i / from->width, from->data + 4 * (size_t)i);
		i++;
	}
	return (0);
}

int	mlx_pixel_put(void *mlx, void *window, int x, int y, int colour)
{
	unsigned char	pixel[4];

	(void)mlx;
	pixel[0] = colour & 255;
	pixel[1] = colour >> 8 & 255;
	pixel[2] = colour >> 16 & 255;
	pixel[3] = 0;
	copy_pixel(window, x, y, pixel);
	return (0);
}

int	mlx_loop(void *mlx)
{
	int	frames;

	(void)mlx;
	frames = 3;
	if (getenv("MLX_FRAMES"))
		frames = atoi(getenv("MLX_FRAMES"));
	if (g_expose_hook)
		g_expose_hook(g_expose_data);
	while (g_loop_hook && frames-- > 0)
		g_loop_hook(g_loop_data);
	write_window();
	return (0);
}

int	mlx_loop_end(void *mlx)
{
	(void)mlx;
	write_window();
	return (0);
}

int	mlx_loop_hook(void *mlx, int (*hook)(), void *data)
{
	(void)mlx;
	g_loop_hook = (t_hook)hook;
	g_loop_data = data;
	return (0);
}

int	mlx_expose_hook(void *window, int (*hook)(), void *data)
{
	(void)window;
	g_expose_hook = (t_hook)hook;
	g_expose_data = data;
	return (0);
}

int	mlx_hook(void *window, int event, int mask, int (*hook)(), void *data)
{
	(void)mask;
	if (event == 12)
		mlx_expose_hook(window, hook, data);
	return (0);
}

int	mlx_key_hook(void *window, int (*hook)(), void *data)
{
	(void)window;
	(void)hook;
	(void)data;
	return (0);
}

int	mlx_mouse_hook(void *window, int (*hook)(), void *data)
{
	return (mlx_key_hook(window, hook, data));
}

int	mlx_string_put(void *mlx, void *window, int x, int y, int colour, char *text)
{
	(void)mlx;
	(void)window;
	(void)x;
	(void)y;
	(void)colour;
	(void)text;
	return (0);
}

int	mlx_clear_window(void *mlx, void *window)
{
	t_pixels	*cleared;

	(void)mlx;
	cleared = window;
	memset(cleared->data, 0, 4 * (size_t)cleared->width * cleared->height);
	return (0);
}

/* Nothing is destroyed: the window is written when the program ends. */

int	mlx_destroy_window(void *mlx, void *window)
{
	(void)mlx;
	(void)window;
	return (0);
}

int	mlx_destroy_image(void *mlx, void *image)
{
	return (mlx_destroy_window(mlx, image));
}

int	mlx_destroy_display(void *mlx)
{
	return (mlx_destroy_window(mlx, NULL));
}

int	mlx_do_sync(void *mlx)
{
	return (mlx_destroy_window(mlx, NULL));
}

int	mlx_do_key_autorepeaton(void *mlx)
{
	return (mlx_destroy_window(mlx, NULL));
}

int	mlx_do_key_autorepeatoff(void *mlx)
{
	return (mlx_destroy_window(mlx, NULL));
}

int	mlx_get_screen_size(void *mlx, int *width, int *height)
{
	(void)mlx;
	*width = 1920;
	*height = 1080;
	return (0);
}

int	mlx_mouse_get_pos(void *mlx, void *window, int *x, int *y)
{
	(void)mlx;
	(void)window;
	*x = 0;
	*y = 0;
	return (0);
}

unsigned int	mlx_get_color_value(void *mlx, int colour)
{
	(void)mlx;
	return ((unsigned int)colour);
}

/* Textures are grey squares. */

void	*mlx_xpm_file_to_image(void *mlx, char *file, int *width, int *height)
{
	t_pixels	*pixels;

	(void)mlx;
	(void)file;
	*width = 64;
	*height = 64;
	pixels = new_pixels(*width, *height);
	if (pixels)
		memset(pixels->data, 128, 4 * (size_t)*width * *height);
	return (pixels);
}
