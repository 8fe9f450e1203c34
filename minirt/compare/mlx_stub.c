/*
** A MiniLibX without a screen: what a program draws into its window is written to a picture.
**
** Build your program with this file in place of the library, and run it:
**
**     cc -o mini *.c mlx_stub.c -lm
**     MLX_PICTURE=mine.ppm ./mini scene.rt
**
** Windows and images are arrays of pixels (blue, green, red, unused). mlx_loop calls the loop hook MLX_FRAMES times
** (without: until the window has not changed for 3 turns, at most 20000), writes the window to MLX_PICTURE (window.ppm
** without) and ends the program.
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

static unsigned long	sum_of_window(void)
{
	unsigned long	sum;
	size_t			i;

	sum = 0;
	i = 0;
	while (g_window && i < 4 * (size_t)g_window->width * g_window->height)
		sum = sum * 31 + g_window->data[i++];
	return (sum);
}

int	mlx_loop(void *mlx)
{
	unsigned long	sum;
	int				left;
	int				still;

	(void)mlx;
	left = 20000;
	if (getenv("MLX_FRAMES"))
		left = atoi(getenv("MLX_FRAMES"));
	if (g_expose_hook)
		g_expose_hook(g_expose_data);
	still = 0;
	while (g_loop_hook && left-- > 0 && (still < 3 || getenv("MLX_FRAMES")))
	{
		sum = sum_of_window();
		g_loop_hook(g_loop_data);
		still = (still + 1) * (sum == sum_of_window());
	}
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

int	mlx_clear_window(void *mlx, void *window)
{
	t_pixels	*cleared;

	(void)mlx;
	cleared = window;
	memset(cleared->data, 0, 4 * (size_t)cleared->width * cleared->height);
	return (0);
}

/*
** Keys and buttons are never pressed, text and cursors are not drawn, and nothing is destroyed: the window is written
** when the program ends. Each of these functions takes any arguments.
*/

#define NOTHING(name) int	name(void) { return (0); }

NOTHING(mlx_key_hook)
NOTHING(mlx_mouse_hook)
NOTHING(mlx_string_put)
NOTHING(mlx_set_font)
NOTHING(mlx_destroy_window)
NOTHING(mlx_destroy_image)
NOTHING(mlx_destroy_display)
NOTHING(mlx_do_sync)
NOTHING(mlx_sync)
NOTHING(mlx_do_key_autorepeaton)
NOTHING(mlx_do_key_autorepeatoff)
NOTHING(mlx_mouse_move)
NOTHING(mlx_mouse_hide)
NOTHING(mlx_mouse_show)

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

void	*mlx_png_file_to_image(void *mlx, char *file, int *width, int *height)
{
	return (mlx_xpm_file_to_image(mlx, file, width, height));
}

void	*mlx_xpm_to_image(void *mlx, char **lines, int *width, int *height)
{
	(void)lines;
	return (mlx_xpm_file_to_image(mlx, NULL, width, height));
}
