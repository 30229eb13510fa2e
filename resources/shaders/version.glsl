#version 410 core
// First piece of every fragment shader that shares others.
