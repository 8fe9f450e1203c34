"""Packing: a scene becomes the arrays that the kernel reads.

They number what is in a scene in five ways; `ShapeArrays` holds what leads from one number to the next.

number        counts                                 rows of                       leads to
shape         the s shapes, as `scene.shapes` does   `boxes`, hits of pixels       `first_primitive[shape]`,
                                                                                   `places[shape]`
primitive     each shape once, a mesh once for       `slots`, colours, materials   `owner[primitive]`, a shape
              each of its triangles: n
slot          a kind of shape and a row in its       `tables[group]`               `slots[primitive]` is one
              table: group and row
listed place  the s shapes in the order of lists     `balls`, `cones`, `written`,  `listed[place]`: its slot,
              for culling; a crowd lies in it        lists of tiles and lights     first primitive and shape
              along Morton's curve
part          the primitives of one shape, such as   triangles of a file           primitive less the first
              the triangles of a mesh                                              one of its shape
"""
