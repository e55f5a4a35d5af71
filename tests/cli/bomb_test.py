"""Bombs: small files that unpack, or unfold, to what no memory holds. Each is refused early, in a sentence.

Usage: bomb_test.py COAPT_BINARY [unittest arguments]
"""
import base64
import os
import resource
import struct
import subprocess
import tempfile
import unittest
import zlib

from command_case import COAPT, CommandCase

READS_VOLUMES = "with    ITK" in subprocess.run([COAPT, "--version"], capture_output=True, text=True).stdout
GIGABYTE = 1 << 30
MOST_BYTES = 500 << 20  # of memory, the program itself (some 40 MB) included
MOST_SECONDS = 10       # of the processor


def of_zeros(size, window=zlib.MAX_WBITS):
    """zlib's (or gzip's) packing of so many zeros, made piece by piece."""
    packer, piece = zlib.compressobj(9, zlib.DEFLATED, window), bytes(1 << 20)
    packed = b"".join(packer.compress(piece) for _ in range(size >> 20)) + packer.compress(bytes(size & 0xFFFFF))
    return packed + packer.flush()


def vtp_block(packed, declared):
    """A compressed array as VTK writes it, in one block that says to hold so many bytes."""
    header = struct.pack("<4Q", 1, declared, 0, len(packed))
    return (base64.b64encode(header) + base64.b64encode(packed)).decode()


def vtp(pieces, appended=""):
    return (f'<VTKFile type="PolyData" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">'
            f'<PolyData>{pieces}</PolyData>{appended}</VTKFile>')


def piece(points, kind="Float64"):
    return f'<Piece><Points><DataArray type="{kind}" NumberOfComponents="3" {points}</DataArray></Points></Piece>'


def limited():
    """A defect is to end this test, not the machine."""
    resource.setrlimit(resource.RLIMIT_CPU, (60, 60))


class Bombs(CommandCase):
    def measured(self, *arguments):
        """Exit code, what was printed, and what the process used."""
        with tempfile.TemporaryFile() as out:
            run = subprocess.Popen([COAPT, *map(str, arguments)], stdout=out, stderr=subprocess.STDOUT, preexec_fn=limited)
            _, status, used = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            return run.returncode, out.read().decode(), used

    def assert_refused(self, path, *pieces):
        commands = {".vtp": ["export", path, "-o", self.folder / "out.obj"], ".feb": ["import", path, "-o", self.folder / "out"]}
        code, said, used = self.measured(*commands.get(path.suffix, ["image", "info", path]))
        self.assertEqual(code, 2, said[-600:])
        self.assertIn(f"coapt: error: {path}: ", said)
        self.assertLess(len(said), 2000)
        for words in pieces:
            self.assertIn(words, said)
        self.assertLess(used.ru_maxrss << 10, MOST_BYTES, said)
        self.assertLess(used.ru_utime + used.ru_stime, MOST_SECONDS, said)

    def written(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def test_arrays_that_announce_more_than_a_mesh_holds(self):
        for kind, size in [("Float64", GIGABYTE), ("UInt8", GIGABYTE >> 3)]:
            bomb = vtp(piece('format="binary">' + vtp_block(of_zeros(size), size), kind))
            self.assert_refused(self.written("b.vtp", bomb), "Points: announces ", " MB", "write it uncompressed")

    def test_arrays_that_hold_more_than_they_announce(self):
        bomb = vtp(piece('format="binary">' + vtp_block(of_zeros(GIGABYTE), 72)))
        self.assert_refused(self.written("b.vtp", bomb), "Points: compressed data are damaged")

    def test_arrays_that_announce_more_than_they_hold(self):
        bomb = vtp(piece('format="binary">' + vtp_block(of_zeros(2 << 20), GIGABYTE)))
        self.assert_refused(self.written("b.vtp", bomb), "Points: announces ")

    def test_pieces_that_share_one_array(self):
        size = 24 << 20
        shared = piece('format="appended" offset="0">') * 2000
        bomb = vtp(shared, f'<AppendedData encoding="base64">_{vtp_block(of_zeros(size), size)}</AppendedData>')
        self.assert_refused(self.written("b.vtp", bomb), "Points: announces ")
        plain = base64.b64encode(struct.pack("<Q", size >> 4) + bytes(size >> 4)).decode()
        bomb = vtp(shared, f'<AppendedData encoding="base64">_{plain}</AppendedData>').replace(
            ' compressor="vtkZLibDataCompressor"', "")
        self.assert_refused(self.written("b.vtp", bomb), "Points: announces ")

    def test_entities_that_unfold(self):
        laughs = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 20))
        head = f'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a0 "{"ha" * 50}">{laughs}]>'
        of_mesh = vtp(piece('format="ascii">&a19;'))
        of_model = '<febio_spec version="4.0"><Mesh><Nodes><node id="1">&a19;</node></Nodes></Mesh></febio_spec>'
        for name, root in [("b.vtp", of_mesh), ("b.feb", of_model)]:
            self.assert_refused(self.written(name, head + root), "'&a19;' is not a number")

    def test_elements_deep_within_each_other(self):
        deep = "<a>" * 1000000 + "</a>" * 1000000
        for name, root in [("b.vtp", vtp(deep)), ("b.feb", f'<febio_spec version="4.0">{deep}</febio_spec>')]:
            self.assert_refused(self.written(name, root))

    @unittest.skipUnless(READS_VOLUMES, "this build reads no volumes")
    def test_volumes_that_announce_more_than_they_hold(self):
        zlibs = "ObjectType = Image\nNDims = 3\nDimSize = {}\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\nCompressedData = True\nElementDataFile = LOCAL\n"
        gzips = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: {}\nspacings: 1 1 1\nencoding: gzip\n\n"
        for name, head, window in [("b.mha", zlibs, zlib.MAX_WBITS), ("b.nrrd", gzips, zlib.MAX_WBITS | 16)]:
            packed = of_zeros(2 << 20, window)
            for sizes, said in [("2048 2048 2048", "more than the 1.07e+09 that are read"), ("400 400 400", "")]:
                self.assert_refused(self.written(name, head.format(sizes).encode() + packed), said)

    @unittest.skipUnless(READS_VOLUMES, "this build reads no volumes")
    def test_of_volumes_no_more_is_unpacked_than_they_announce(self):
        head = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nCompressedData = True\nElementDataFile = LOCAL\n"
        run, said, used = self.measured("image", "info", self.written("b.mha", head.encode() + of_zeros(GIGABYTE)))
        self.assertEqual(run, 0, said)
        self.assertLess(used.ru_maxrss << 10, MOST_BYTES)


if __name__ == "__main__":
    unittest.main(argv=[__file__])
