find_package(OpenEXR 3.1 REQUIRED)
find_package(ZLIB REQUIRED)
whit_tests(images whit_io whit_inspect ZLIB::ZLIB OpenEXR::OpenEXR)
