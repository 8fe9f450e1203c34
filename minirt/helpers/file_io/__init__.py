"""Files: written as a whole or not at all, read if they are regular, locked, and kept for this user alone."""

from minirt.helpers.file_io.private import PRIVATE_FILE as PRIVATE_FILE
from minirt.helpers.file_io.private import PRIVATE_FOLDER as PRIVATE_FOLDER
from minirt.helpers.file_io.private import is_private as is_private
from minirt.helpers.file_io.private import lock as lock
from minirt.helpers.file_io.private import unlock as unlock
from minirt.helpers.file_io.private import user_folder as user_folder
from minirt.helpers.file_io.reading import LARGEST_ASSET as LARGEST_ASSET
from minirt.helpers.file_io.reading import check_size as check_size
from minirt.helpers.file_io.reading import found as found
from minirt.helpers.file_io.reading import is_absent as is_absent
from minirt.helpers.file_io.reading import is_file as is_file
from minirt.helpers.file_io.reading import is_folder as is_folder
from minirt.helpers.file_io.reading import is_stream as is_stream
from minirt.helpers.file_io.reading import located as located
from minirt.helpers.file_io.reading import read as read
from minirt.helpers.file_io.reading import read_given as read_given
from minirt.helpers.file_io.reading import read_once as read_once
from minirt.helpers.file_io.reading import reason as reason
from minirt.helpers.file_io.reading import stamps as stamps
from minirt.helpers.file_io.reading import status as status
from minirt.helpers.file_io.writing import create as create
from minirt.helpers.file_io.writing import delete as delete
from minirt.helpers.file_io.writing import probe as probe
from minirt.helpers.file_io.writing import told_errors as told_errors
from minirt.helpers.file_io.writing import write as write
